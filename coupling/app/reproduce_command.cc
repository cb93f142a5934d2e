// reproduce: the page of the sources' figures beside ours.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "coupling/app/commands.h"
#include "coupling/app/terminal.h"
#include "coupling/output/atomic_file.h"
#include "coupling/reproduce/page.h"
#include "coupling/reproduce/record.h"
#include "coupling/system/printable.h"

namespace grainfield::coupling {

void add_reproduce(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("reproduce", "the sources' figures beside ours, from summaries");
  auto folder = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  command->add_option("folder", *folder, "holds CASE.json: the summary.json of each study")
      ->required();
  auto add = std::make_shared<std::vector<std::string>>();
  command
      ->add_option("--add", *add,
                   "folder of a finished run: its summary, profiles and pictures come first")
      ->allow_extra_args(false);
  add_output(*command, *output, "page to write; default: print it");
  command->callback([=, &action] {
    action = [=] {
      for (const std::string& run : *add) {
        for (const std::string& file : record_run(run, *folder)) say("{}\n", printable_name(file));
      }
      const std::string page = reproduction_page(Results(*folder));
      if (output->empty()) {
        say("{}", page);
      } else {
        write_text_file(*output, page);
        say("{}\n", printable_name(*output));
      }
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
