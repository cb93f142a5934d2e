#include "coupling/base/failure.h"

#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "continuum/model.h"
#include "coupling/base/mistakes.h"
#include "coupling/base/signals.h"
#include "dem/shared/computation_failed.h"
#include "dem/storage_failed.h"

namespace grainfield::coupling {
namespace {

// What the name of a file that the user gave can be wrong by.
bool is_name(const std::error_code& error) {
  for (const std::errc kind :
       {std::errc::filename_too_long, std::errc::not_a_directory, std::errc::permission_denied,
        std::errc::too_many_symbolic_link_levels, std::errc::no_such_file_or_directory,
        std::errc::is_a_directory}) {
    if (error == kind) return true;
  }
  return false;
}

int code_of(const std::error_code& error) {
  return dem::means_storage_failed(error) ? kExitStorage : is_name(error) ? 2 : 1;
}

}  // namespace

Failure failure_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Interrupted& e) {
    return {kExitInterrupted, e.what()};
  } catch (const Mistakes& e) {
    return {2, e.what(), e.lines()};
  } catch (const std::invalid_argument& e) {
    return {2, e.what()};
  } catch (const ComputationFailed& e) {
    return {3, e.what()};
  } catch (const dem::StorageFailed& e) {
    return {kExitStorage, e.what()};
  } catch (const std::filesystem::filesystem_error& e) {
    return {code_of(e.code()), e.path1().string() + ": " + e.code().message()};
  } catch (const std::system_error& e) {
    return {code_of(e.code()), e.what()};
  } catch (const std::bad_alloc&) {
    return {1, "out of memory"};
  } catch (const std::exception& e) {
    return {1, e.what()};
  }
}

}  // namespace grainfield::coupling
