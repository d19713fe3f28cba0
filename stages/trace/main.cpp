#include "common/stage/program.h"
#include "stages/trace/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::trace_stage(), argc, argv); }
