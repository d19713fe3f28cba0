#include "common/stage/program.h"
#include "stages/tensor/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::tensor_stage(), argc, argv); }
