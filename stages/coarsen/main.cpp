#include "common/stage/program.h"
#include "stages/coarsen/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::coarsen_stage(), argc, argv); }
