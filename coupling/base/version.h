// Which grainfield this is.
#pragma once
#include <string>

namespace grainfield::coupling {

/// "MAJOR.MINOR.PATCH".
std::string version();
/// With the commit it was built from, and "+" where files had been changed since: "0.9.0
/// (4e1bdbb)". The version alone when it was built outside a repository.
std::string version_and_commit();

}  // namespace grainfield::coupling
