/// Reports of the benchmark: a page, Markdown, LaTeX and CSV, without time and place, so that the
/// same figures give the same bytes.
#pragma once

#include <string>

#include "hg/studies/haptify/figures.h"

namespace hg::apps {

/// The table of goals.h for a terminal, and the failures.
std::string goals_text(const haptify::Benchmark& goals);
/// The goals in Markdown, without a title; `command` reproduces them.
std::string goals_markdown(const haptify::Benchmark& goals, const std::string& command);

/// The benchmark for a terminal: table, missed goals, failures.
std::string haptify_text(const haptify::Benchmark& result);
/// The benchmark as a self-contained page; `command` reproduces it.
std::string haptify_html(const haptify::Benchmark& result, const std::string& command);
/// The benchmark in Markdown, without a title; `command` reproduces it.
std::string haptify_markdown(const haptify::Benchmark& result, const std::string& command);
/// Table III with our column: a tabular for the package booktabs.
std::string haptify_latex(const haptify::Benchmark& result);
/// CSV with one row per figure: mean, half width, repetitions, the published values.
std::string haptify_csv(const haptify::Benchmark& result);
/// CSV with one row per figure and repetition.
std::string repetitions_csv(const haptify::Benchmark& result);
std::string table_csv(const haptify::Table& table);

}  // namespace hg::apps
