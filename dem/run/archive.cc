#include "dem/run/archive.h"

namespace grainfield::dem {

void Archive::operator()(std::map<std::string, double>& numbers) {
  std::vector<double> values;
  std::string names;
  for (const auto& [name, value] : numbers) {
    names += name + "\n";
    values.push_back(value);
  }
  (*this)(names);
  (*this)(values);
  if (!is_reading()) return;
  numbers.clear();
  std::size_t from = 0;
  for (const double value : values) {
    const std::size_t end = names.find('\n', from);
    require(end != std::string::npos);
    numbers[names.substr(from, end - from)] = value;
    from = end + 1;
  }
  require(from == names.size());
}

void Archive::snapshot(std::optional<Snapshot>& snapshot, const std::string& name) {
  int there = snapshot.has_value() ? 1 : 0;
  (*this)(there);
  if (!is_reading()) {
    if (there != 0) snapshots_.emplace_back(name, *snapshot);
    return;
  }
  snapshot.reset();
  if (there != 0) snapshot = read_snapshot(file_, "/" + name);
}

void Archive::engine(std::unique_ptr<Engine>& engine,
                     const std::function<std::unique_ptr<Engine>()>& make) {
  std::string checkpoint = engine && !is_reading() ? engine->checkpoint() : "";
  (*this)(checkpoint);
  if (!is_reading()) return;
  engine.reset();
  if (checkpoint.empty()) return;
  engine = make();
  engine->restore(checkpoint);
}

void Archive::require(bool holds) const {
  if (reader_) reader_->require(holds);
}

void Archive::finish() const {
  if (reader_) reader_->finish();
}

void ArchivedRun::save(const std::string& file) const {
  Archive archive;
  // Writing changes nothing of what it is shown.
  const_cast<ArchivedRun*>(this)->visit(archive);
  write_checkpoint(file, fingerprint(), archive.written(), archive.snapshots());
}

void ArchivedRun::restore(const std::string& file) {
  Archive archive(read_checkpoint(file, fingerprint()), file);
  visit(archive);
  archive.finish();
}

}  // namespace grainfield::dem
