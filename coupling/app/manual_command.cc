// manual: pages of the manual and the completion of bash as files, for who installs the program;
// the generated pages docs/commands.md and docs/columns.md.
#include <filesystem>
#include <memory>

#include "coupling/app/commands.h"
#include "coupling/app/manual.h"
#include "coupling/store/atomic_file.h"

namespace grainfield::coupling {

void add_manual(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("manual", "pages of the manual and completion of bash");
  command->group("");  // not in --help: it is for building packages
  auto folder = std::make_shared<std::string>();
  add_output(*command, *folder, "folder: man1/, completions/grainfield, pages/")->required();
  command->callback([=, &app, &action] {
    action = [=, &app] {
      const std::filesystem::path root(*folder);
      std::filesystem::create_directories(root / "man1");
      std::filesystem::create_directories(root / "completions");
      write_text_file((root / "man1/grainfield.1").string(), manual_of_program(app));
      for (const CLI::App* shown : shown_commands(app)) {
        write_text_file((root / "man1" / ("grainfield-" + shown->get_name() + ".1")).string(),
                        manual_of_command(*shown));
      }
      write_text_file((root / "completions/grainfield").string(), bash_completion(app));
      std::filesystem::create_directories(root / "pages");
      write_text_file((root / "pages/commands.md").string(), commands_markdown(app));
      write_text_file((root / "pages/columns.md").string(), columns_markdown());
      return 0;
    };
  });
}

}  // namespace grainfield::coupling
