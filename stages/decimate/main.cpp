#include "common/stage/program.h"
#include "stages/decimate/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::decimate_stage(), argc, argv); }
