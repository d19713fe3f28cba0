#include "common/stage/program.h"
#include "stages/size/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::size_stage(), argc, argv); }
