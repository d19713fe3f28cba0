#include "common/stage/program.h"
#include "stages/tensor/merge/stage.h"

int main(int argc, char** argv) {
  return strake::stage_main(strake::tensor_merge_stage(), argc, argv);
}
