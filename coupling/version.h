// Which grainfield this is.
#pragma once
#include <string>

namespace grainfield::coupling {

/// "0.1.0".
std::string version();
/// With the commit it was built from, and "+" where files had been changed since: "0.1.0
/// (4e1bdbb)". The version alone when it was built outside a repository.
std::string version_and_commit();

}  // namespace grainfield::coupling
