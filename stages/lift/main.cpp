#include "common/stage/program.h"
#include "stages/lift/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::lift_stage(), argc, argv); }
