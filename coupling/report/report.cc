#include "coupling/report/report.h"

#include <fmt/format.h>

#include <boost/beast/core/detail/base64.hpp>
#include <regex>
#include <sstream>

#include "coupling/report/drawing.h"
#include "coupling/store/atomic_file.h"

namespace grainfield::coupling {
namespace {

constexpr const char* style_sheet = R"(
body{font:16px/1.5 "DejaVu Sans",Helvetica,Arial,sans-serif;color:#222;max-width:1040px;margin:2em auto;padding:0 1em}
h1{font-size:1.7em;margin-bottom:0}h2{font-size:1.2em;margin:2em 0 .4em;border-bottom:1px solid #ddd}
.subtitle{color:#666;margin-top:.2em}.verdict{font-size:1.12em;background:#f3f6fa;border-left:5px solid #0072b2;padding:.8em 1em}
figure{margin:0 0 1em}figure img,figure svg{max-width:100%;height:auto}figcaption{color:#555;font-size:.9em}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.9em}td,th{padding:.25em .8em;text-align:right;border-bottom:1px solid #e4e4e4}
td:first-child,th:first-child{text-align:left}th{border-bottom:2px solid #888}th[title]{text-decoration:underline dotted;cursor:help}.number{white-space:nowrap}.missing,.doubt{background:#fff4e0;padding:.6em 1em}
)";

std::string escape(const std::string& text) {
  std::string out;
  for (char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

// Names of pages beside this one lead there.
std::string linked(const std::string& text) {
  static const std::regex page(R"(\b[A-Za-z0-9_/-]+\.html\b)");
  return std::regex_replace(text, page, R"(<a href="$&">$&</a>)");
}

std::string base64(const std::string& bytes) {
  namespace codec = boost::beast::detail::base64;
  std::string out(codec::encoded_size(bytes.size()), '\0');
  out.resize(codec::encode(out.data(), bytes.data(), bytes.size()));
  return out;
}

std::string heading(const std::string& title) {
  return title.empty() ? "" : "<h2>" + escape(title) + "</h2>\n";
}

class Page {
 public:
  explicit Page(ReportResult& result) : result_(result), gnuplot_(find_gnuplot()) {}

  std::string operator()(const Text& text) const {
    std::string out = heading(text.title), paragraph;
    std::istringstream lines(text.body);
    const auto flush = [&] {
      if (!paragraph.empty())
        out += fmt::format("<p{}>{}</p>\n",
                           text.verdict ? " class=\"verdict\""
                           : text.doubt ? " class=\"doubt\""
                                        : "",
                           linked(escape(paragraph)));
      paragraph.clear();
    };
    for (std::string line; std::getline(lines, line);) {
      if (line.empty())
        flush();
      else
        paragraph += (paragraph.empty() ? "" : " ") + line;
    }
    flush();
    return out;
  }

  std::string operator()(const Table& table) const {
    std::string out = heading(table.title) + "<div class=\"scroll\"><table>\n";
    if (!table.header.empty()) out += "<tr>";
    for (std::size_t k = 0; k < table.header.size(); ++k) {
      const bool told = k < table.meanings.size() && !table.meanings[k].empty();
      out += fmt::format("<th{}>{}</th>",
                         told ? " title=\"" + escape(table.meanings[k]) + "\"" : std::string(),
                         escape(table.header[k]));
    }
    if (!table.header.empty()) out += "</tr>\n";
    for (const auto& cells : table.rows) {
      out += "<tr>";
      for (const std::string& cell : cells) {
        const bool number = cell.find("±") != std::string::npos && cell.size() < 40;
        out +=
            fmt::format("<td{}>{}</td>", number ? " class=\"number\"" : "", linked(escape(cell)));
      }
      out += "</tr>\n";
    }
    out += "</table></div>\n";
    if (!table.caption.empty()) out += "<p class=\"subtitle\">" + escape(table.caption) + "</p>\n";
    return out;
  }

  std::string operator()(const Picture& picture) {
    std::string image;
    if (!gnuplot_) {
      image = missing("gnuplot not found: install gnuplot-nox");
    } else {
      const Drawing drawing = draw_picture(*gnuplot_, picture, picture.bitmap);
      if (drawing.bytes.empty())
        image = missing("gnuplot failed: " + drawing.error);
      else
        image = embed(picture, drawing.bytes);
    }
    std::string caption = picture.caption;
    if (picture.band) {
      caption += std::string(caption.empty() ? "" : " ") +
                 "The grey band is one standard error on either side.";
    }
    return heading(picture.title) + "<figure>" + image +
           (caption.empty() ? "" : "<figcaption>" + escape(caption) + "</figcaption>") +
           "</figure>\n";
  }

 private:
  std::string missing(const std::string& why) {
    result_.why_missing = why;
    ++result_.missing;
    return "<p class=\"missing\">No picture: " + escape(why) + ".</p>";
  }

  // As an image with its own address space: the ids of several SVG pictures would clash inline.
  std::string embed(const Picture& picture, const std::string& bytes) {
    ++result_.pictures;
    return fmt::format(
        "<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/{};base64,{}\">",
        picture.width, picture.height, escape(picture.title), picture.bitmap ? "png" : "svg+xml",
        base64(bytes));
  }

  ReportResult& result_;
  std::optional<std::string> gnuplot_;
};

}  // namespace

void add_rows(Report& report, const std::string& title, const ReportRows& rows,
              const std::string& caption) {
  if (rows.empty()) return;
  Table table{title, caption, {}, {}};
  for (const auto& [name, value] : rows) table.rows.push_back({name, value});
  report.sections.emplace_back(std::move(table));
}

std::string ReportResult::complaint() const {
  if (missing == 0) return "";
  const int all = pictures + missing;
  return fmt::format("report.html: {} of {} picture{} missing: {}", missing, all,
                     all == 1 ? " is" : "s are", why_missing);
}

ReportResult write_report(const std::string& file, const Report& report) {
  ReportResult result;
  Page page(result);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>{1}</style></head><body>\n<h1>{0}</h1>\n<p class=\"subtitle\">{2}</p>\n",
      escape(report.title), style_sheet, escape(report.subtitle));
  for (const Section& section : report.sections) html += std::visit(page, section);
  html += "</body></html>\n";
  write_text_file(file, html);
  return result;
}

}  // namespace grainfield::coupling
