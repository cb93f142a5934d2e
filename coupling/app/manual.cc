#include "coupling/app/manual.h"

#include <fmt/format.h>

#include "coupling/base/version.h"

namespace grainfield::coupling {
namespace {

// A line of text as man reads it: no dash is a hyphen, no line begins with a command.
std::string plain_roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\n') {
      out += ' ';
    } else {
      if (out.empty() && (c == '.' || c == '\'')) out += "\\&";
      out += c;
    }
  }
  return out;
}

std::string heading(std::string name) {
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return fmt::format(".TH {} 1 \"\" \"grainfield {}\" \"grainfield\"\n", name, version());
}

std::string metavar(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type == "INT" || type == "UINT" || type == "FLOAT" ? "NUMBER" : "TEXT";
}

bool takes_many(const CLI::Option& option) { return option.get_items_expected_max() > 1; }

/// "-o, --output TEXT", bold and italic.
std::string tag(const CLI::Option& option) {
  std::string out;
  const auto add = [&](const std::string& name) {
    if (!out.empty()) out += ", ";
    out += fmt::format("\\fB{}\\fR", plain_roff(name));
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  if (!is_flag(option)) out += fmt::format(" \\fI{}\\fR", metavar(option));
  return out;
}

std::string item(const std::string& name, const std::string& meaning) {
  return fmt::format(".TP\n{}\n{}\n", name, plain_roff(meaning));
}

std::string options_text(const CLI::App& command) {
  std::string out = ".SH OPTIONS\n";
  for (const CLI::Option* option : dashed_options(command)) {
    std::string meaning = option->get_description();
    if (option->get_required()) meaning += " (required)";
    out += item(tag(*option), meaning);
  }
  return out;
}

const char* const kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
The work is done.
.TP
.B 2
A mistake in what was given; one line names it.
.TP
.B 3
A computation failed; the line says what to change.
.TP
.B 74
An output cannot be written.
.TP
.B 130
Interrupted. A run has left a checkpoint.
)";

}  // namespace

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  std::vector<const CLI::App*> out;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) out.push_back(command);  // the others are hidden
  }
  return out;
}

std::vector<const CLI::Option*> dashed_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* o) { return o->nonpositional(); });
}

std::vector<const CLI::Option*> positional_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* o) { return o->get_positional(); });
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::string manual_of_program(const CLI::App& app) {
  const std::vector<const CLI::App*> commands = shown_commands(app);
  std::string out = heading("grainfield");
  out += ".SH NAME\ngrainfield \\- grains in, fields out, and a verdict on the continuum models\n";
  out += ".SH SYNOPSIS\n.B grainfield\n.I COMMAND\n[\\fIARGUMENTS\\fR]\n";
  out +=
      ".SH DESCRIPTION\nA discrete\\-element simulation and the continuum theories stand side by "
      "side, on the same points, with error bars. Each command has a page of its own.\n";
  out += ".SH COMMANDS\n";
  for (const CLI::App* command : commands) {
    out += item(fmt::format("\\fBgrainfield {}\\fR", plain_roff(command->get_name())),
                command->get_description());
  }
  out += options_text(app) + kExitStatus;
  out += ".SH ENVIRONMENT\n" +
         item("\\fBGRAINFIELD_CASES\\fR",
              "Folder of the shipped cases, instead of that beside the program.") +
         item("\\fBGRAINFIELD_PREFIX\\fR",
              "Folder above lib/grainfield and share/grainfield, instead of the one above the "
              "program's own: for programs that link the libraries.");
  out += ".SH SEE ALSO\n";
  for (std::size_t n = 0; n < commands.size(); ++n) {
    out += fmt::format(".BR grainfield\\-{} (1){}\n", plain_roff(commands[n]->get_name()),
                       n + 1 < commands.size() ? "," : "");
  }
  return out;
}

std::string manual_of_command(const CLI::App& command) {
  const std::string name = plain_roff(command.get_name());
  std::string out = heading("grainfield\\-" + name);
  out += fmt::format(".SH NAME\ngrainfield\\-{} \\- {}\n", name,
                     plain_roff(command.get_description()));
  out += fmt::format(".SH SYNOPSIS\n.B grainfield {}\n", name);
  const auto positional = positional_options(command);
  for (const CLI::Option* option : positional) {
    const std::string word =
        plain_roff(option->get_name(true)) + (takes_many(*option) ? "..." : "");
    out +=
        option->get_required() ? fmt::format(".I {}\n", word) : fmt::format("[\\fI{}\\fR]\n", word);
  }
  out += "[\\fIOPTIONS\\fR]\n";
  if (!positional.empty()) {
    out += ".SH ARGUMENTS\n";
    for (const CLI::Option* option : positional) {
      out += item(fmt::format("\\fI{}\\fR", plain_roff(option->get_name(true))),
                  option->get_description());
    }
  }
  out += options_text(command) + kExitStatus;
  return out + ".SH SEE ALSO\n.BR grainfield (1)\n";
}

}  // namespace grainfield::coupling
