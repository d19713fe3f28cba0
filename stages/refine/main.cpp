#include "common/stage/program.h"
#include "stages/refine/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::refine_stage(), argc, argv); }
