#include "common/stage/program.h"
#include "stages/fit/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::fit_stage(), argc, argv); }
