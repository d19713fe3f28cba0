#include "common/stage/program.h"
#include "stages/import/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::import_stage(), argc, argv); }
