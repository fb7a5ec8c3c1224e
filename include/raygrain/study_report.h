// From result files of studies to a report: the paper's figures and tables beside the published values, then what goes
// beyond them.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "raygrain/chart.h"

namespace raygrain {

/// A results file: a header and rows of as many cells. Columns have the names of docs/formats.md whatever the file
/// calls them ("combo" and "name" become "recipe", ...).
struct ResultTable {
  std::string study;  // what the rows call it, else the name of the file; of results.csv what study.txt beside it says,
                      // else of its folder
  std::string path;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// Reads RFC 4180 CSV. Throws Error: kNotFound, kUnreadable, kMalformed (file:line) for what is empty, is no results
/// file, has rows of another length, a column twice, or text where a number belongs.
ResultTable load_results(const std::string& path);

struct ChartSection {
  std::string id, title, text;
  std::vector<Chart> charts;
};

struct StudyReport {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // what was measured, and on what
  std::vector<ChartSection> sections;
  std::vector<std::pair<std::string, std::string>> links = {};  // to pages that show what was measured: name, address
};

struct StudyReportOptions {
  std::string baseline = {};  // the recipe, with its setting, that others are held against; empty: SAH+LSPH or near it
  std::vector<std::string> scenes = {};  // rows of these alone; empty: all
};

/// Every chart that the tables hold values for. Recipes that raygrain does not know appear like its own. The same
/// tables give the same report. Throws Error (kUsage) for no tables, and for a baseline or scene that none of them has.
StudyReport make_study_report(std::span<const ResultTable> tables, const StudyReportOptions& options = {});

/// The report as JSON for the interactive page: its structures, with NaN as null.
std::string study_report_json(const StudyReport& report);

/// One self-contained HTML file: the interactive page (the text of a built report-page.html) filled with the report.
/// Throws Error (kMalformed, naming `path`) for a text that has no place for it.
std::string interactive_page(const StudyReport& report, const std::string& page, const std::string& path);

/// The same as plain HTML with SVG pictures, without any script. `note` says how to get the other one; may be empty.
std::string static_page(const StudyReport& report, const std::string& note);

/// A summary in Markdown. `picture` returns the link of a panel's picture, empty for none.
std::string report_markdown(const StudyReport& report,
                            const std::function<std::string(const Chart&, size_t panel)>& picture);

}  // namespace raygrain
