// average, strain, import, model, compare, fit, structure under signals: the short form
// of reliability_commands_long_test.cc.
#include "tests/coupling/reliability_commands.h"

namespace grainfield::coupling::testing {
namespace {

TEST(Commands, OutputsAreOldOrNew) { interrupt_commands(4).print(); }

}  // namespace
}  // namespace grainfield::coupling::testing
