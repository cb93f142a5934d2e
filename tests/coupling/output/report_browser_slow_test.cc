// Reports in a browser, opened from the file: no message on the console, every picture there and
// with a size. Left out where headless Chromium is not installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/coupling/layer_verdict_case.h"
#include "tests/coupling/program.h"

namespace grainfield::coupling::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    if (std::system((std::string("command -v ") + name + " > /dev/null 2>&1").c_str()) == 0) {
      return name;
    }
  }
  return "";
}

struct Shown {
  int code = 0;
  std::string page, messages;
};

Shown show(const Folder& folder, const std::string& file) {
  const std::string command =
      "timeout 120 " + browser() +
      " --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --enable-logging=stderr "
      "--log-level=0 --virtual-time-budget=20000 --user-data-dir=" +
      (folder / "profile") + " --dump-dom file://" + file + " > " + (folder / "dom") + " 2> " +
      (folder / "log");
  Shown out;
  out.code = std::system(command.c_str());
  out.page = read_text(folder / "dom");
  out.messages = read_text(folder / "log");
  return out;
}

// The page itself holds no script; a copy with one counts what the browser made of its pictures.
void expect_good_page(const Folder& folder, const std::string& file) {
  const std::string html = read_text(file);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  const Shown plain = show(folder, file);
  ASSERT_EQ(plain.code, 0) << plain.messages;
  EXPECT_THAT(plain.page, HasSubstr("</table>"));
  // Messages of the page carry CONSOLE; the browser's own (no D-Bus, no GPU) do not.
  EXPECT_THAT(plain.messages, Not(HasSubstr("CONSOLE"))) << file;
  const std::string probe = R"(<script>
window.addEventListener('load', () => {
  const all = [...document.images];
  const good = all.filter(i => i.complete && i.naturalWidth > 50 && i.naturalHeight > 50 &&
                               i.getBoundingClientRect().width > 50).length;
  document.title = 'pictures ' + all.length + ' good ' + good +
                   ' wide ' + (document.documentElement.scrollWidth > innerWidth + 1 ? 'yes' : 'no');
});
</script></body>)";
  std::string copy = html;
  copy.replace(copy.rfind("</body>"), 7, probe);
  const Shown probed = show(folder, folder.write("probe.html", copy));
  std::smatch found;
  ASSERT_TRUE(std::regex_search(probed.page, found,
                                std::regex("<title>pictures ([0-9]+) good ([0-9]+) wide (\\w+)")))
      << probed.page.substr(0, 500);
  EXPECT_GE(std::stoi(found[1]), 3) << file;
  EXPECT_EQ(found[1], found[2]) << file;
  EXPECT_EQ(found[3], "no") << "the page is wider than the window: " << file;
  EXPECT_THAT(html, Not(HasSubstr("class=\"missing\"")));
}

TEST(ReportInABrowser, EveryPictureIsThere) {
  if (browser().empty()) GTEST_SKIP() << "no chromium here: apt-get install chromium";
  if (std::system("command -v gnuplot > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no gnuplot here: the report has no pictures";
  }
  const Folder folder;
  const std::string file = folder.write("verdict.toml", tiny_verdict());
  const Output run = program("run " + file + " -o " + (folder / "out"));
  ASSERT_EQ(run.code, 0) << run.err;
  expect_good_page(folder, folder / "out/report.html");
  expect_good_page(folder, folder / "out/even/report.html");
}

}  // namespace
}  // namespace grainfield::coupling::testing
