#include "common/stage/program.h"
#include "stages/evaluate/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::evaluate_stage(), argc, argv); }
