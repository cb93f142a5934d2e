// What a checkpoint holds of a run: one list, for writing and for reading.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "dem/engine/engine.h"
#include "dem/image/image.h"
#include "dem/run/common.h"
#include "dem/run/run.h"

namespace grainfield::dem {

/// Shown a value, it keeps the value's bits, or puts back those that were kept: whoever lists his
/// members once can be saved and restored. Reading throws std::invalid_argument when the bits do
/// not fit.
class Archive {
 public:
  /// Writes.
  Archive() = default;
  /// Reads `bytes`; the snapshots are in `file`.
  Archive(std::string bytes, std::string file)
      : bytes_(std::move(bytes)), file_(std::move(file)), reader_(std::in_place, bytes_) {}
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  bool is_reading() const { return reader_.has_value(); }
  /// Plain values (image.h), vectors of them and strings.
  template <class T>
  void operator()(T& value) {
    if (reader_) {
      reader_->get(value);
    } else {
      writer_.put(value);
    }
  }
  void operator()(std::map<std::string, double>& figures);
  /// A snapshot that may be there, under a name of its own.
  void snapshot(std::optional<Snapshot>& snapshot, const std::string& name);
  /// An engine that may be there; make() gives it for reading, with its walls and without grains.
  void engine(std::unique_ptr<Engine>& engine,
              const std::function<std::unique_ptr<Engine>()>& make);

  /// Reading: throws unless this holds of what was read.
  void require(bool holds) const;
  /// Reading: throws when there is more than what was asked for.
  void finish() const;
  const ImageWriter& written() const { return writer_; }
  const NamedSnapshots& snapshots() const { return snapshots_; }

 private:
  ImageWriter writer_;
  NamedSnapshots snapshots_;
  std::string bytes_, file_;
  std::optional<ImageReader> reader_;
};

/// A run that says what a checkpoint of it holds, and is saved and restored by that.
class ArchivedRun : public Run {
 public:
  void save(const std::string& file) const final;
  void restore(const std::string& file) final;

 protected:
  /// Shows the archive everything that changes while the run goes on.
  virtual void visit(Archive& archive) = 0;
  /// All settings, to tell checkpoints of different setups apart.
  virtual std::string fingerprint() const = 0;
};

}  // namespace grainfield::dem
