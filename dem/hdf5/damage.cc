#include "dem/hdf5/damage.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <vector>

#include "dem/cannot_read_now.h"
#include "dem/hdf5/file.h"

namespace grainfield::dem::hdf5 {
namespace {

// Deflate, the strongest usual filter, makes data at most 1032 times smaller.
constexpr hsize_t kMostCompression = 1100;
// Bytes of a dataset that nothing was written to: it reads as zeros.
constexpr hsize_t kMostUnwritten = 64 << 20;
// Bytes of one number.
constexpr std::size_t kLargestNumber = 16;

// Whether any message on the error stack of the last call fits.
template <class Fits>
bool any_error(Fits fits) {
  struct Search {
    Fits& fits;
    bool found = false;
  } search{fits};
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto& s = *static_cast<Search*>(data);
        s.found = s.found || s.fits(*error);
        return 0;
      },
      &search);
  return search.found;
}

// The product, or `limit` when it is above.
hsize_t product(const std::vector<hsize_t>& factors, hsize_t first, hsize_t limit) {
  hsize_t out = first;
  for (const hsize_t f : factors) {
    if (f == 0) return 0;
    if (out > limit / f) return limit;
    out *= f;
  }
  return out;
}

}  // namespace

void prepare() {
  static std::once_flag once;
  std::call_once(once, [] {
    // We close what we open: at the program's end HDF5 would write once more to files that could
    // not be closed on a full disk, and crash.
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5Lunregister(H5L_TYPE_EXTERNAL);
  });
}

hsize_t file_size(hid_t object) {
  const Handle file(H5Iget_file_id(object), H5Fclose);
  hsize_t size = 0;
  return file.valid() && H5Fget_filesize(file, &size) >= 0 ? size : 0;
}

std::string unreadable(hid_t set) {
  const Handle type(H5Dget_type(set), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) return "not numbers";
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > kLargestNumber) return "of an unknown type of number";
  const Handle properties(H5Dget_create_plist(set), H5Pclose);
  if (!properties.valid()) return "broken";
  const H5D_layout_t layout = H5Pget_layout(properties);
  if (layout < 0) return "broken";
  if (layout == H5D_VIRTUAL || (layout == H5D_CONTIGUOUS && H5Pget_external_count(properties) != 0))
    return "its data lie in another file";
  const Handle space(H5Dget_space(set), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) return "broken";
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank)), chunk(shape);
  if (rank > 0 && H5Sget_simple_extent_dims(space, shape.data(), nullptr) < 0) return "broken";

  const int filters = H5Pget_nfilters(properties);
  if (filters < 0) return "broken";
  const hsize_t whole = file_size(set);
  const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(set), whole);
  const hsize_t most = std::max(kMostUnwritten, layout == H5D_CONTIGUOUS || filters == 0
                                                    ? stored
                                                    : kMostCompression * std::min(stored, whole));
  if (product(shape, size, most + 1) > most) return "larger than its file";
  if (layout == H5D_CHUNKED && rank > 0 &&
      (H5Pget_chunk(properties, rank, chunk.data()) != rank ||
       product(chunk, size, most + 1) > most)) {
    return "in chunks larger than its file";
  }
  return "";
}

bool checksum_failed() {
  return any_error([](const H5E_error2_t& error) {
    const std::string_view text = error.desc != nullptr ? error.desc : "";
    return text.find("checksum") != std::string_view::npos;
  });
}

bool out_of_memory() {
  return any_error([](const H5E_error2_t& error) {
    return error.maj_num == H5E_RESOURCE && error.min_num == H5E_NOSPACE;
  });
}

int error_of_the_moment() {
  int found = 0;
  any_error([&](const H5E_error2_t& error) {
    // "..., errno = 13, error message = ..."
    constexpr std::string_view kErrno = "errno = ";
    const std::string_view text = error.desc != nullptr ? error.desc : "";
    const std::size_t at = text.find(kErrno);
    if (at == std::string_view::npos) return false;
    const int number = std::atoi(error.desc + at + kErrno.size());
    if (means_cannot_read_now(number)) found = number;
    return found != 0;
  });
  return found;
}

}  // namespace grainfield::dem::hdf5
