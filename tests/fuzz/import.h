// Files of other programs, as `import` reads them.
#pragma once
#include <string>
#include <string_view>

namespace grainfield::fuzz {

/// The bytes are files of the format with lines "%%" between them. Other lines that begin with %
/// are options of the command: "%wall floor:y=0", "%column i=c_id[1]", "%periodic x=0:1", "%dim 3",
/// "%density 2500", "%fixed type=2", "%all", "%alone" (without contacts), "%flip", "%near" (leave
/// out distant ones). Others count for nothing.
void import_bytes(const std::string& format, std::string_view bytes);

}  // namespace grainfield::fuzz
