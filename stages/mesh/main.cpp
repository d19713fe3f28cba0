#include "common/stage/program.h"
#include "stages/mesh/stage.h"

int main(int argc, char** argv) { return strake::stage_main(strake::mesh_stage(), argc, argv); }
