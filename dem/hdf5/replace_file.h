// Files that take their place only when all of them is on the disk.
#pragma once
#include <filesystem>
#include <string>
#include <utility>

namespace grainfield::dem {

/// Renames `beside` to `target` after its bytes are on the disk, and the folder's entry after: a
/// power cut leaves the old file or the new one, whole. Throws StorageFailed naming the target.
void replace_file(const std::string& beside, const std::string& target);

/// The name that a file which is being written will have: without the marks of FILE.part, of
/// .FILE.0123456789abcdef.part and of a folder .partial on the way. For messages.
std::string final_name(const std::string& path);

/// write(FILE.part), which then takes FILE's place. When that fails FILE.part goes and FILE stays
/// as it was. Throws what write throws, and StorageFailed.
template <class Write>
void write_in_place_of(const std::string& file, Write write) {
  const std::string beside = file + ".part";
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  try {
    write(std::as_const(beside));
    replace_file(beside, file);
  } catch (...) {
    std::filesystem::remove(beside, ignored);
    throw;
  }
}

}  // namespace grainfield::dem
