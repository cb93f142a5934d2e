#include "coupling/app/program.h"

int main(int argc, char** argv) { return grainfield::coupling::run_program(argc, argv); }
