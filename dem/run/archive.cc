#include "dem/run/archive.h"

namespace grainfield::dem {

void Archive::operator()(std::map<std::string, double>& figures) {
  std::vector<double> values;
  std::string names;
  for (const auto& [key, value] : figures) {
    names += key + "\n";
    values.push_back(value);
  }
  (*this)(names);
  (*this)(values);
  if (!is_reading()) return;
  figures.clear();
  std::size_t at = 0, k = 0;
  for (std::size_t end; (end = names.find('\n', at)) != std::string::npos; at = end + 1, ++k) {
    require(k < values.size());
    figures[names.substr(at, end - at)] = values[k];
  }
  require(k == values.size());
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
  std::string image = engine && !is_reading() ? engine->image() : "";
  (*this)(image);
  if (!is_reading()) return;
  engine.reset();
  if (image.empty()) return;
  engine = make();
  engine->restore(image);
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
