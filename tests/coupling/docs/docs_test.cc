// The documentation itself: links lead somewhere, works cited are in the bibliography, pictures say
// how they were made, versions agree.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "coupling/base/version.h"
#include "coupling/specimen/pile_frame.h"
#include "coupling/tasks/measured_share.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling {
namespace {

using ::testing::HasSubstr;
using testing::read_text;
using testing::fs::path;

const path kRoot = GRAINFIELD_SOURCES;

std::vector<path> pages() {
  std::vector<path> out;
  for (const auto& entry : testing::fs::directory_iterator(kRoot)) {
    if (entry.path().extension() == ".md") out.push_back(entry.path());
  }
  for (const auto& entry : testing::fs::recursive_directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

// The page without what stands between fences or in backticks: no links are there.
std::string prose(const std::string& text) {
  std::istringstream lines(text);
  std::string line, out;
  bool code = false;
  while (std::getline(lines, line)) {
    if (line.compare(0, 3, "```") == 0) {
      code = !code;
    } else if (!code) {
      out += std::regex_replace(line, std::regex("`[^`]*`"), "`") + "\n";
    }
  }
  return out;
}

// What repositories make of a heading: small letters, digits, - and _; blanks become -.
std::string anchor_of(const std::string& heading) {
  // The text of a link counts, not where it leads.
  const std::string text =
      std::regex_replace(heading, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1");
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || c == '-' || c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) {
      out += c;
    } else if (c >= 'A' && c <= 'Z') {
      out += static_cast<char>(c - 'A' + 'a');
    } else if (c == ' ') {
      out += '-';
    }
  }
  // Capitals outside ASCII that headings here begin with.
  return std::regex_replace(out, std::regex("Š"), "š");
}

std::set<std::string> anchors_of(const path& page) {
  std::set<std::string> out;
  std::istringstream lines(read_text(page.string()));
  std::string line;
  bool code = false;
  while (std::getline(lines, line)) {
    if (line.compare(0, 3, "```") == 0) code = !code;
    std::smatch found;
    if (code || !std::regex_match(line, found, std::regex("#+ +(.*?) *"))) continue;
    const std::string anchor = anchor_of(found[1]);
    std::string name = anchor;
    for (int n = 1; out.count(name) != 0; ++n) name = anchor + "-" + std::to_string(n);
    out.insert(name);
  }
  return out;
}

/// "page: link" for every link that leads nowhere.
std::vector<std::string> broken_links(const path& page, int* links) {
  std::vector<std::string> out;
  const std::string text = prose(read_text(page.string()));
  const std::regex link(R"(\]\(([^()\s]+)\))");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), link); at != std::sregex_iterator();
       ++at) {
    const std::string target = (*at)[1];
    if (target.find("://") != std::string::npos || target.compare(0, 7, "mailto:") == 0) continue;
    ++*links;
    const std::size_t hash = target.find('#');
    const std::string file = target.substr(0, hash);
    const path there = file.empty() ? page : page.parent_path() / file;
    const bool anchored = hash != std::string::npos && there.extension() == ".md";
    if (!testing::fs::exists(there) ||
        (anchored && anchors_of(there).count(target.substr(hash + 1)) == 0)) {
      out.push_back(testing::fs::relative(page, kRoot).string() + ": " + target);
    }
  }
  return out;
}

TEST(Docs, LinksLeadSomewhere) {
  int links = 0;
  for (const path& page : pages()) {
    EXPECT_THAT(broken_links(page, &links), ::testing::IsEmpty());
  }
  EXPECT_GT(links, 300);
}

TEST(Docs, BrokenLinksAreFound) {
  const testing::Folder folder;
  const path page =
      folder.write("a.md", "# A b\n[x](#a-b) [y](#a) [z](none.md) `[c](q.md)` [w](a.md#a-b)\n");
  int links = 0;
  EXPECT_EQ(broken_links(page, &links).size(), 2U);
  EXPECT_EQ(links, 4);
}

/// "case: what is wrong" for every shipped case that the gallery does not lead to. The gallery has
/// [`case`](cases/PAGE.md#section); PAGE has the command that runs it.
std::vector<std::string> cases_without_page(const std::string& gallery, const path& folder,
                                            const std::set<std::string>& cases) {
  std::vector<std::string> out;
  for (const std::string& name : cases) {
    std::smatch link;
    if (!std::regex_search(gallery, link,
                           std::regex("\\[`" + name + "`\\]\\((cases/[a-z0-9-]+\\.md)[)#]"))) {
      out.push_back(name + ": not in the gallery");
      continue;
    }
    const path page = folder / link[1].str();
    if (!testing::fs::exists(page) ||
        !std::regex_search(read_text(page.string()),
                           std::regex("grainfield run (cases/)?" + name + "[.\\s`]"))) {
      out.push_back(name + ": not on " + link[1].str());
    }
  }
  return out;
}

TEST(Docs, GalleryLeadsToThePageOfEveryCase) {
  std::set<std::string> cases;
  for (const auto& entry : testing::fs::directory_iterator(kRoot / "cases")) {
    if (entry.path().extension() == ".toml") cases.insert(entry.path().stem());
  }
  EXPECT_GT(cases.size(), 50U);
  EXPECT_THAT(
      cases_without_page(read_text((kRoot / "docs/gallery.md").string()), kRoot / "docs", cases),
      ::testing::IsEmpty());
}

TEST(Docs, CasesWithoutPageAreFound) {
  const testing::Folder folder;
  testing::fs::create_directories(path(folder / "cases"));
  folder.write("cases/p.md", "grainfield run cases/a.toml\n");
  EXPECT_THAT(cases_without_page("[`a`](cases/p.md#a) [`b`](cases/p.md) [`d`](cases/q.md)",
                                 path(folder / "."), {"a", "b", "c", "d"}),
              ::testing::ElementsAre("b: not on cases/p.md", "c: not in the gallery",
                                     "d: not on cases/q.md"));
}

/// What stands between `[@` and `]` on the pages: keys of docs/references.bib.
std::set<std::string> cited_keys(const std::string& text) {
  std::set<std::string> out;
  if (text.find("[@") == std::string::npos) return out;
  const std::string told = prose(text);
  const std::regex citation(R"(\[@([^\]\s]+)\])");
  for (auto at = std::sregex_iterator(told.begin(), told.end(), citation);
       at != std::sregex_iterator(); ++at) {
    out.insert((*at)[1]);
  }
  return out;
}

struct Work {
  std::string key, text;
};

/// The entries of a bibliography in the order of the file: from a line @kind{key, to a line }.
std::vector<Work> works(const std::string& bibliography) {
  std::vector<Work> out;
  std::istringstream lines(bibliography);
  std::string line;
  bool inside = false;
  while (std::getline(lines, line)) {
    if (!inside && !line.empty() && line.front() == '@') {
      const std::size_t brace = line.find('{');
      out.push_back({line.substr(brace + 1, line.rfind(',') - brace - 1), ""});
      inside = true;
    } else if (line == "}") {
      inside = false;
    } else if (inside) {
      out.back().text += line + "\n";
    }
  }
  return out;
}

std::set<std::string> keys_of(const std::string& bibliography) {
  std::set<std::string> out;
  for (const Work& work : works(bibliography)) out.insert(work.key);
  return out;
}

/// "page: key" for every citation of a work that is not known.
std::vector<std::string> unknown_works(const path& page, const std::set<std::string>& known,
                                       int* citations) {
  std::vector<std::string> out;
  for (const std::string& key : cited_keys(read_text(page.string()))) {
    ++*citations;
    if (known.count(key) == 0) {
      out.push_back(testing::fs::relative(page, kRoot).string() + ": " + key);
    }
  }
  return out;
}

TEST(Docs, CitedWorksAreInTheBibliography) {
  const auto known = keys_of(read_text((kRoot / "docs/references.bib").string()));
  int citations = 0;
  for (const path& page : pages()) {
    EXPECT_THAT(unknown_works(page, known, &citations), ::testing::IsEmpty());
  }
  EXPECT_GT(citations, 30);
}

TEST(Docs, CitationsOfUnknownWorksAreFound) {
  const testing::Folder folder;
  const path page = folder.write("a.md", "See [@love1927], [@none2000] and `[@key]`.\n");
  int citations = 0;
  const auto known = keys_of("@book{love1927,\n  year = {1927}\n}\n");
  EXPECT_THAT(unknown_works(page, known, &citations),
              ::testing::ElementsAre(::testing::EndsWith("a.md: none2000")));
  EXPECT_EQ(citations, 2);
}

// A key ends in its work's year; a DOI has the form of one, without the resolver's address.
TEST(Docs, BibliographyIsComplete) {
  const std::string bibliography = read_text((kRoot / "docs/references.bib").string());
  std::set<std::string> keys;
  for (const Work& work : works(bibliography)) {
    EXPECT_TRUE(keys.insert(work.key).second) << work.key << " twice";
    std::smatch year;
    ASSERT_TRUE(std::regex_match(work.key, year, std::regex("[a-z]+([0-9]{4})[a-z]?"))) << work.key;
    for (const std::string& field : {std::string("author += "), std::string("title += "),
                                     "year += \\{" + year[1].str() + "\\}"}) {
      EXPECT_TRUE(std::regex_search("\n" + work.text, std::regex("\n  " + field)))
          << work.key << ": " << field;
    }
    std::smatch doi;
    if (std::regex_search(work.text, doi, std::regex(R"(\n  doi += \{(.*)\})"))) {
      EXPECT_TRUE(std::regex_match(doi[1].str(), std::regex(R"(10\.[0-9]{4,5}/[^{}\s]+)")))
          << work.key << ": " << doi[1];
    }
  }
  EXPECT_GT(keys.size(), 100U);
}

TEST(Docs, NameTheThresholdOfHeapsThatAreNoWedges) {
  const std::string page = read_text((kRoot / "docs/fits.md").string());
  EXPECT_THAT(page, HasSubstr(fmt::format("weigh {:g} times their wedge", kMostOverWedge)));
  EXPECT_THAT(page, HasSubstr(fmt::format("carry less than {:g} or more than {:g} times the weight",
                                          kLeastShare, kMostShare)));
}

// docs/images/pictures.toml: a table for every picture with the command that makes it.
TEST(Docs, EveryPictureNamesItsCommand) {
  const std::string list = read_text((kRoot / "docs/images/pictures.toml").string());
  std::set<std::string> listed, there, shown;
  const std::regex table(R"re(\n\["([^"]+)"\])re");
  for (auto at = std::sregex_iterator(list.begin(), list.end(), table);
       at != std::sregex_iterator(); ++at) {
    EXPECT_TRUE(listed.insert((*at)[1]).second) << (*at)[1] << " twice";
  }
  // From where the list lies.
  const path folder = kRoot / "docs/images";
  const auto name_of = [&](const path& picture) {
    return picture.lexically_normal().lexically_relative(folder).string();
  };
  for (const auto& entry : testing::fs::recursive_directory_iterator(kRoot / "docs")) {
    const std::string kind = entry.path().extension();
    if (kind == ".svg" || kind == ".png") there.insert(name_of(entry.path()));
  }
  for (const path& page : pages()) {
    const std::string text = read_text(page.string());
    const std::regex picture(R"re((\]\(|src=")([^()"\s]+\.(svg|png)))re");
    for (auto at = std::sregex_iterator(text.begin(), text.end(), picture);
         at != std::sregex_iterator(); ++at) {
      if (const std::string target = (*at)[2]; target.find("://") == std::string::npos) {
        shown.insert(name_of(page.parent_path() / target));
      }
    }
  }
  EXPECT_EQ(listed, there);
  EXPECT_EQ(shown, there) << "pictures that no page shows, or that are not there";
}

// The list has the settings with which the summary beside a recorded picture was made.
TEST(Docs, RecordedPicturesNameTheCommandOfTheirSummary) {
  const std::string list = read_text((kRoot / "docs/images/pictures.toml").string());
  const std::regex table(
      R"re(\["\.\./reproduction/results/([a-z-]+)\.([a-z-]+\.[a-z]+)"\]\nrun = \[([^\n]*(\n[^\n]*){0,3})\]\npicture)re");
  // With the states in the repository instead of the grains that the run poured.
  const std::regex kept(R"re( --set 'grains\.files=\[[^']*\]')re");
  int recorded = 0;
  for (auto at = std::sregex_iterator(list.begin(), list.end(), table);
       at != std::sregex_iterator(); ++at, ++recorded) {
    const std::string name = (*at)[1];
    std::string runs = (*at)[3];
    const std::size_t states = runs.find("]\nstates = [");
    if (states != std::string::npos) {
      runs = std::regex_replace(runs.substr(0, states), kept, "");
    }
    const std::string summary =
        read_text((kRoot / "docs/reproduction/results" / (name + ".json")).string());
    std::smatch command;
    ASSERT_TRUE(std::regex_search(
        summary, command,
        std::regex(
            R"re("case\.command": "grainfield run cases/([a-z-]+)\.toml(([^"\\]|\\.)*)")re")))
        << name;
    EXPECT_THAT(runs, ::testing::EndsWith(command[1].str() + command[2].str() + "\"")) << name;
  }
  EXPECT_EQ(recorded, 12);
}

TEST(Docs, VersionsAgree) {
  const std::string here = version();
  EXPECT_THAT(read_text((kRoot / "CITATION.cff").string()), HasSubstr("\nversion: " + here + "\n"));
  const std::string changes = read_text((kRoot / "CHANGELOG.md").string());
  EXPECT_THAT(changes, HasSubstr("\n## Unreleased\n"));
  // What is being worked on is the next release, or one that has its date.
  EXPECT_TRUE(changes.find("will be " + here) != std::string::npos ||
              changes.find("\n## " + here + " - ") != std::string::npos);
}

}  // namespace
}  // namespace grainfield::coupling
