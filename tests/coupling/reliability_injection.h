// Titles, labels, names of files and folders, environment: text stays text. Nothing of it is
// executed, every picture is drawn, no control byte and no endless line reaches the terminal.
#pragma once
#include <gmock/gmock.h>

#include "reliability_scene.h"

namespace grainfield::coupling::testing {

// What shells and gnuplot would run, quoted in every way: each would make the file "executed".
using Texts = std::vector<std::string>;
inline const Texts kEvil{"it's",
                         "' ; touch executed ; echo '",
                         "\"; touch executed; \"",
                         "`touch executed`",
                         "$(touch executed)",
                         "'; system('touch executed'); '",
                         "\" ; system(\"touch executed\") ; \"",
                         "@executed",
                         "a\nsystem 'touch executed'\n! touch executed\n",
                         "!touch executed",
                         "%s%n%s%n {} {0} {:999999999}",
                         "\x1b[31mred\x1b]0;title\x07\x1b[2J",
                         "</script><script>alert(1)</script><img src=x onerror=alert(1)>",
                         "\xc2\x9b"
                         "31m c1",
                         "\xff\xfe broken utf-8 \x80",
                         "tab\there, return\rback, delete\x7f, bell\a"};

// As a TOML string; bytes that TOML does not allow are left out.
inline std::string toml(const std::string& text) {
  std::string out = "\"";
  for (const char ch : text) {
    const auto byte = static_cast<unsigned char>(ch);
    if (ch == '"' || ch == '\\') {
      out += std::string("\\") + ch;
    } else if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\u{:04x}", byte);
    } else {
      out += ch;
    }
  }
  return out + "\"";
}

inline bool is_utf8(const std::string& text) {
  return text.find('\xff') == std::string::npos && text.find("\xc2\x9b") == std::string::npos;
}

// A name that a file can have: no slash.
inline std::string file_name(std::string text) {
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
}

inline void expect_harmless(const std::string& stream) {
  for (std::size_t k = 0; k < stream.size(); ++k) {
    const auto byte = static_cast<unsigned char>(stream[k]);
    const bool plain = byte >= 0x20 && byte != 0x7f;
    ASSERT_TRUE(plain || byte == '\n' || byte == '\t')
        << "byte " << int{byte} << " after: " << stream.substr(k < 60 ? 0 : k - 60, 60);
    const bool c1 =
        byte == 0xc2 && k + 1 < stream.size() && static_cast<unsigned char>(stream[k + 1]) < 0xa0;
    ASSERT_FALSE(c1) << "a C1 control character";
  }
  std::istringstream lines(stream);
  for (std::string line; std::getline(lines, line);)
    ASSERT_LE(line.size(), 2000U) << line.substr(0, 200);
}

inline void expect_harmless(const Ending& ending, const Folder& folder) {
  EXPECT_EQ(ending.signal, 0) << ending;
  expect_harmless(ending.out);
  expect_harmless(ending.err);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    ASSERT_NE(entry.path().filename(), "executed");
}

inline int count(const std::string& text, const std::string& word) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++found;
  return found;
}

// As many as with an innocent title.
inline void expect_all_pictures(const std::string& report) {
  static const int expected = [] {
    const Folder folder;
    const std::string file = folder.write("x.toml", small_layer());
    EXPECT_EQ(finish({{"run", file, "-o", folder / "out"}, {}, "", {}}).code, 0);
    return count(read_text(folder / "out/report.html"), "data:image/");
  }();
  EXPECT_GT(expected, 3);
  EXPECT_EQ(count(report, "data:image/"), expected);
  EXPECT_EQ(count(report, "class=\"missing\""), 0);
}

inline std::string titled(const std::string& title) {
  std::string text = small_layer();
  const std::string was = "\"small layer\"";
  return text.replace(text.find(was), was.size(), toml(title));
}

inline void inject_titles(const Texts& evils) {
  for (const std::string& evil : evils) {
    if (!is_utf8(evil)) continue;
    const Folder folder;
    const Ending ending =
        finish({{"run", folder.write("x.toml", titled(evil)), "-o", "out"}, {}, folder.path(), {}});
    EXPECT_EQ(ending.code, 0) << ending;
    expect_harmless(ending, folder);
    const std::string report = read_text(folder / "out/report.html");
    expect_all_pictures(report);
    EXPECT_EQ(count(report, "<script>alert"), 0);
    EXPECT_EQ(count(report, "<img src=x"), 0);
  }
}

// A label may be refused, by check already; where it is taken it is drawn.
inline void inject_labels(const Texts& evils) {
  for (const std::string& evil : evils) {
    if (!is_utf8(evil)) continue;
    const Folder folder;
    std::string text = small_layer("[model." + toml(evil) + "]\nname = \"layer\"\n");
    const std::string was = "[\"flamant\"]";
    text.replace(text.find(was), was.size(), "[\"flamant\", " + toml(evil) + "]");
    const std::string file = folder.write("x.toml", text);
    const Ending checked = finish({{"check", file}, {}, folder.path(), {}});
    expect_harmless(checked, folder);
    const Ending run = finish({{"run", file, "-o", "out"}, {}, folder.path(), {}});
    expect_harmless(run, folder);
    EXPECT_EQ(run.code, checked.code) << evil << ": " << run;
    if (run.code == 0) {
      expect_all_pictures(read_text(folder / "out/report.html"));
    } else {
      EXPECT_EQ(run.code, 2) << run;
    }
  }
}

inline void inject_variants(const Texts& evils) {
  for (const std::string& evil : evils) {
    if (!is_utf8(evil)) continue;
    const Folder folder;
    const std::string file =
        folder.write("x.toml", small_layer("[sweep]\nkey = \"variant\"\nvalues = [" + toml(evil) +
                                           "]\n[variant." + toml(evil) + ".load]\nforce = 2\n"));
    const Ending checked = finish({{"check", file}, {}, folder.path(), {}});
    expect_harmless(checked, folder);
    const Ending run = finish({{"run", file, "-o", "out"}, {}, folder.path(), {}});
    expect_harmless(run, folder);
    EXPECT_EQ(run.code, checked.code) << evil << ": " << run;
    EXPECT_TRUE(run.code == 0 || run.code == 2) << run;
  }
}

inline void inject_names(const Texts& evils) {
  for (const std::string& evil : evils) {
    const Folder folder;
    const std::string name = file_name(evil);
    const std::string file = folder.write(name + ".toml", small_layer());
    const Ending run = finish({{"run", name + ".toml", "-o", name}, {}, folder.path(), {}});
    expect_harmless(run, folder);
    ASSERT_EQ(run.code, 0) << run;
    expect_all_pictures(read_text(folder / (name + "/report.html")));
    const std::string snapshots = "./" + name + "/snapshots.h5";
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"info", name + "/fields.h5"},
             {"compare", name + "/fields.h5", "--model", "flamant", "-o", name + "2"},
             {"average", name + "/snapshots.h5:loaded", "--grid", "5x4", "-o", name + ".h5"},
             {"structure", name + "/snapshots.h5", "-o", name + "3"},
             {"check", name + ".toml"}}) {
      const Ending ending = finish({words, {}, folder.path(), {}});
      expect_harmless(ending, folder);
      // A colon parts a file from what is in it.
      EXPECT_TRUE(ending.code == 0 || evil.find(':') != std::string::npos) << words[0] << ending;
    }
  }
}

inline void inject_environment(const Texts& evils) {
  for (const std::string& evil : evils) {
    const Folder folder;
    const std::string temporary = folder / file_name(evil);
    if (evil != "missing") fs::create_directory(temporary);
    const std::string file = folder.write("x.toml", small_layer());
    const Ending run =
        finish({{"run", file, "-o", "out"},
                {},
                folder.path(),
                {{"TMPDIR", temporary}, {"GNUTERM", evil}, {"LC_ALL", evil}, {"LANG", evil}}});
    expect_harmless(run, folder);
    EXPECT_EQ(run.code, 0) << run;
    expect_all_pictures(read_text(folder / "out/report.html"));
  }
}

inline void inject_mistakes(const Texts& evils) {
  const Workshop& inputs = workshop();
  for (const std::string& evil : evils) {
    const Folder folder;
    std::vector<std::vector<std::string>> tries{
        {evil},
        {"run", evil},
        {"check", inputs.case_file(), "--set", evil},
        {"check", inputs.case_file(), "--set", "material.friction=" + evil},
        {"check", inputs.case_file(), "--set", evil + "=1"},
        {"run", inputs.case_file(), "--threads", evil},
        {"info", evil},
        {"keys", evil},
        {"model", evil},
        {"model", "flamant", "--set", evil + "=1"},
        {"average", inputs.snapshot() + evil, "-o", "f.h5"},
        {"average", inputs.snapshot(), "--grid", evil, "-o", "f.h5"},
        {"compare", inputs.fields(), "--model", evil, "-o", "c"},
        {"import", "--from", evil, "x", "-o", "s.h5"},
        {"run", inputs.case_file(), "-o", "/dev/null/" + evil}};
    for (const std::string& place :
         {"title = 1\n[" + toml(evil) + "]\n", "[material]\n" + toml(evil) + " = 1\n",
          "[material]\nfriction = " + toml(evil) + "\n", "study = " + toml(evil) + "\n",
          "# " + evil + "\nx\n", evil + "\n"}) {
      tries.push_back({"check", folder.write("case" + std::to_string(tries.size()), place)});
    }
    tries.push_back({"info", folder.write("text.h5", evil)});
    tries.push_back(
        {"model", "flamant", "--points", folder.write("p.csv", "x,y\n" + evil + ",1\n")});
    tries.push_back({"model", "flamant", "--points", folder.write("q.csv", evil + "\n1,1\n")});
    for (const std::vector<std::string>& words : tries) {
      const Ending ending = finish({words, {}, folder.path(), {}}, 60);
      SCOPED_TRACE(words[0] + " " + words.back().substr(0, 100));
      EXPECT_EQ(ending.code, 2) << ending.err.substr(0, 1000);
      expect_harmless(ending, folder);
    }
  }
}

}  // namespace grainfield::coupling::testing
