#include "common/stage/program.h"
#include "stages/export/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::export_stage(), argc, argv); }
