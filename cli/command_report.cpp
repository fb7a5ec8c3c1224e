// raygrain report: result files of studies as one page of charts, and as Markdown with pictures.
#include <filesystem>
#include <memory>
#include <ostream>

#include <fmt/format.h>

#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/study_report.h"
#include "raygrain/view.h"

#include "cli/built_page.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/output_folder.h"
#include "cli/progress.h"
#include "cli/values.h"
#include "io/text.h"

namespace raygrain::cli {

namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::vector<std::string> results, views;
  std::string page, markdown, page_template;
  StudyReportOptions shown;
  bool plain = false;
};

/// A folder stands for the results.csv of a study or the compare.csv of a comparison in it.
std::string results_file(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return path;
  const fs::path study = fs::path(path) / "results.csv", comparison = fs::path(path) / "compare.csv";
  return (!fs::exists(study, ignored) && fs::exists(comparison, ignored) ? comparison : study).string();
}

void save(const std::string& path, const std::string& text) {
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

/// A path as part of an address.
std::string escaped_path(const std::string& path) {
  std::string text;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    text += plain || std::string_view("/._~-").find(c) != std::string_view::npos
                ? std::string(1, c)
                : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

/// The report with links from a file in `path`'s folder to the views.
StudyReport with_links(StudyReport report, const std::vector<std::string>& views, const std::string& path) {
  const fs::path folder = fs::absolute(path).parent_path();
  for (const std::string& view : views)
    report.links.emplace_back("See " + fs::path(view).stem().string(),
                              escaped_path(fs::absolute(view).lexically_relative(folder).generic_string()));
  return report;
}

void check_views(const std::vector<std::string>& views) {
  std::error_code ignored;
  for (const std::string& view : views) {
    const char* hint = "Make it with raygrain view SCENE --out FILE";
    if (!fs::is_regular_file(view, ignored)) throw Error(ErrorCode::kNotFound, view, "there is no such page", hint);
    if (!is_view_page(read_whole_file(view)))
      throw Error(ErrorCode::kMalformed, view, "is no page of raygrain view", hint);
  }
}

/// The page, and what to tell of it.
std::string make_page(const Options& options, const StudyReport& plain_report) {
  const StudyReport report = with_links(plain_report, options.views, options.page);
  constexpr const char* kNote =
      "Static charts. `make report-page` builds the interactive page (it needs node and npm); `raygrain report` then "
      "fills it instead.";
  const std::string path = options.page_template.empty() ? built_page("report-page.html") : options.page_template;
  if (options.plain || path.empty()) {
    save(options.page, static_page(report, kNote));
    return options.plain ? ""
                         : "The interactive page is not built: these charts are static. make report-page builds it.\n";
  }
  save(options.page, interactive_page(report, read_whole_file(path), path));
  return {};
}

/// The Markdown file, and its pictures in a folder of the same name.
void make_markdown(const Options& options, const StudyReport& report, Progress& progress) {
  const fs::path path(options.markdown);
  const std::string folder = path.stem().string() + "-charts";
  const fs::path pictures = path.parent_path() / folder;
  const OutputFolder made(pictures.string());
  const auto picture = [&](const Chart& chart, size_t panel) {
    const std::string name = fmt::format("{}-{}.png", chart.id, panel + 1);
    progress.show("draw " + name, 0.5);
    save_png(chart_image(chart.panels[panel]), (pictures / name).string());
    return folder + "/" + name;
  };
  save(options.markdown, report_markdown(with_links(report, options.views, options.markdown), picture));
}

/// Figure by figure, one line each: what came out.
std::string summary(const StudyReport& report) {
  std::string text;
  for (const ChartSection& section : report.sections) {
    text += section.title + "\n";
    for (const Chart& chart : section.charts)
      text += fmt::format("  {} [{}] {}\n", chart.label.empty() ? chart.title : chart.label, name(chart.verdict),
                          chart.finding);
  }
  return text;
}

int make_report(const Options& options) {
  if (options.page.empty() && options.markdown.empty() && options.common.json.empty())
    fail_usage("raygrain report", "has nothing to write", "Give --out report.html, --markdown FILE or --json FILE");
  const Output output(options.common);
  require_writable(options.page);
  require_writable(options.markdown);
  check_views(options.views);
  std::vector<ResultTable> tables;
  for (const std::string& path : options.results) tables.push_back(load_results(results_file(path)));
  const StudyReport report = make_study_report(tables, options.shown);

  Progress progress(!options.common.quiet);
  std::string note;
  if (!options.page.empty()) note = make_page(options, report);
  if (!options.markdown.empty()) make_markdown(options, report, progress);
  progress.erase();
  output.save_json(study_report_json(report) + "\n");
  output.print(summary(report));
  output.note(note.empty() ? "" : "\n" + note);
  for (const std::string& path : {options.page, options.markdown})
    if (!path.empty()) output.note("\nWritten: " + path + "\n");
  return kSuccess;
}

}  // namespace

Action declare_report(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operands("RESULTS", options->results,
                     "results.csv files of studies, compare.csv files of comparisons, or folders that hold one");
  arguments.output("--out", "report.html", options->page, "Write the report as one self-contained page");
  arguments.output("--markdown", "FILE", options->markdown,
                   "Write it as Markdown, too, with PNG charts in a folder beside the file");
  arguments.list("--only", "SCENE,...", options->shown.scenes, "Tests in these scenes alone");
  arguments.text("--baseline", "RECIPE", options->shown.baseline,
                 "Hold recipes against this one, named as in the report [SAH+LSPH]");
  arguments.files("--views", "FILE,...", options->views, "Link these pages of raygrain view");
  arguments.flag("--static", options->plain, "Make the page without scripts: SVG charts only");
  arguments.file("--template", "FILE", options->page_template,
                 "The built interactive page to fill [the one beside the program]");
  add_common(arguments, options->common);
  return [options] { return make_report(*options); };
}

}  // namespace raygrain::cli
