#include "common/stage/program.h"
#include "stages/prolong/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::prolong_stage(), argc, argv); }
