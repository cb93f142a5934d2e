#include "coupling/import/ids_table.h"

#include <fmt/format.h>

#include <set>
#include <stdexcept>
#include <unordered_map>

#include "coupling/import/format.h"

namespace grainfield::coupling {

void restore_ids(const std::string& file, dem::Snapshot& snapshot) {
  const ForeignTable table = scan_csv(file, {{"original"}, {}});
  ColumnNames names({});
  const TableColumns columns(table, names);
  const ForeignColumn id = columns.need_theirs("id"), original = columns.need_theirs("original");
  std::unordered_map<std::int64_t, std::int64_t> originals;
  std::set<std::int64_t> seen;
  TableReader().read(table, [&](const ForeignRow& row) {
    const std::int64_t theirs = row.told_id(id).id, ours = row.told_id(original).id;
    if (!originals.emplace(theirs, ours).second)
      row.refuse(fmt::format("column id: found {} again, allowed: each once", theirs));
    if (!seen.insert(ours).second)
      row.refuse(fmt::format("column original: found {} again, allowed: each once", ours));
  });
  const auto original_of = [&](std::int64_t theirs) {
    const auto at = originals.find(theirs);
    if (at != originals.end()) return at->second;
    throw std::invalid_argument(fmt::format(
        "{}: found no row of grain {}, expected one of each grain; without --ids the grains keep "
        "the ids of the files",
        file, theirs));
  };
  if (snapshot.loaded_grain >= 0) snapshot.loaded_grain = original_of(snapshot.loaded_grain);
  for (dem::Grain& grain : snapshot.grains) grain.id = original_of(grain.id);
}

}  // namespace grainfield::coupling
