#include "common/stage/program.h"
#include "stages/refine/worst/stage.h"

int main(int argc, char** argv) {
  return strake::stage_main(strake::refine_worst_stage(), argc, argv);
}
