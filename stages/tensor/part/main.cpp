#include "common/stage/program.h"
#include "stages/tensor/part/stage.h"

int main(int argc, char** argv) {
  return strake::stage_main(strake::tensor_part_stage(), argc, argv);
}
