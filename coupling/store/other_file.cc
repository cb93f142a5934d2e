#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "coupling/store/output_folder.h"

namespace grainfield::coupling {

void require_other_file(const std::string& option, const std::string& output,
                        const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code unknown;  // a file that is not there is no input yet
    if (std::filesystem::equivalent(output, input, unknown))
      throw std::invalid_argument(fmt::format(
          "{}: {} is an input and would be replaced; name another file", option, output));
  }
}

}  // namespace grainfield::coupling
