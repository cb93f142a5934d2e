// samples: packings and a table that come with the program, to try the other commands on.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/base/printable.h"
#include "coupling/case/shipped_cases.h"
#include "coupling/store/atomic_file.h"
#include "coupling/store/output_folder.h"
#include "dem/snapshot/snapshot.h"

namespace grainfield::coupling {
namespace {

void list_sample(const std::filesystem::path& file) {
  if (file.extension() == ".csv") {
    const std::string text = read_text_file(file.string());
    say("{:<14} {} lines\n", file.filename().string(), std::count(text.begin(), text.end(), '\n'));
    return;
  }
  const std::vector<std::string> groups = dem::list_snapshots(file.string());
  if (groups.empty()) return;
  const dem::Snapshot first = dem::read_snapshot(file.string(), groups.front());
  say("{:<14} {}D, {} states, {} grains in the first, {} KiB\n", file.filename().string(),
      first.dim, groups.size(), first.grains.size(), std::filesystem::file_size(file) / 1024);
}

void copy_samples(const std::vector<std::filesystem::path>& files, const std::string& to) {
  OutputFolder folder(to, "grainfield samples");
  for (const auto& file : files) {
    folder.require_other_than({file.string()});
    write_text_file(folder.staging(file.filename().string()), read_text_file(file.string()));
  }
  note_gone(to, folder.publish());
  say("{} files in {}\n", files.size(), printable_name(to));
}

}  // namespace

void add_samples(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("samples", "shipped packings and a measurement to try the commands on");
  auto to = std::make_shared<std::string>();
  add_output(*command, *to, "folder: copies them there");
  command->callback([=, &action] {
    action = [=] {
      const std::vector<std::filesystem::path> files = shipped_samples();
      for (const auto& file : files) list_sample(file);
      if (to->empty()) {
        say("in {}; grainfield samples -o FOLDER copies them\n",
            files.front().parent_path().string());
      } else {
        copy_samples(files, *to);
      }
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
