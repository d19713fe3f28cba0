#include "common/stage/program.h"
#include "stages/smooth/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::smooth_stage(), argc, argv); }
