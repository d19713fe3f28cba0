#include "common/stage/program.h"
#include "stages/restrict/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::restrict_stage(), argc, argv); }
