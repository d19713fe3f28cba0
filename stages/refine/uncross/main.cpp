#include "common/stage/program.h"
#include "stages/refine/uncross/stage.h"

int main(int argc, char** argv) {
  return strake::stage_main(strake::refine_uncross_stage(), argc, argv);
}
