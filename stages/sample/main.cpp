#include "common/stage/program.h"
#include "stages/sample/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::sample_stage(), argc, argv); }
