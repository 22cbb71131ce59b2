#include "bench/figures.h"

#include <gtest/gtest.h>

#include <numeric>

#include "bench/bench_files.h"

namespace hg::bench {
namespace {

Times times_of(const std::vector<double>& us) {
  Times times;
  for (std::size_t i = 0; i < us.size(); ++i) times.add(i, us[i]);
  return times;
}

TEST(Times, TheFastestOfEachCounts) {
  Times times = times_of({3.0, 5.0});
  times.add(0, 4.0);
  times.add(1, 2.0);
  EXPECT_EQ(times.us(), (std::vector{3.0, 2.0}));
  EXPECT_EQ(times.mean(), 2.5);
}

TEST(Times, PercentilesAreExact) {
  std::vector<double> us(2000);
  std::iota(us.rbegin(), us.rend(), 1.0);
  const analysis::Distribution d = times_of(us).distribution();
  EXPECT_EQ(d.median, 1000.0);
  EXPECT_EQ(d.p99_9, 1998.0);
  EXPECT_EQ(d.max, 2000.0);
  EXPECT_EQ(Times().distribution().max, 0.0);
}

TEST(Times, OfFewerThanAThousandThereIsNoTail) {
  EXPECT_EQ(times_of(std::vector(1000, 2.0)).distribution().p99_9, 2.0);
  for (const std::size_t count : {0U, 999U}) {
    const analysis::Distribution d = times_of(std::vector(count, 2.0)).distribution();
    EXPECT_EQ(to_text(d.p99_9, 2), "-");
    nlohmann::ordered_json row;
    add_to(row, d);
    EXPECT_TRUE(row["p99_9_us"].is_null());
    EXPECT_EQ(row["max_us"], count > 0 ? 2.0 : 0.0);
    const std::string most = count > 0 ? "2.0" : "0.0";
    EXPECT_EQ(to_csv(nlohmann::ordered_json::array({row})),
              "median_us,p99_9_us,max_us\n" + most + ",," + most + "\n");
  }
}

TEST(Histogram, EveryTimeIsInTheBinThatHoldsIt) {
  const std::vector<Bin> bins = histogram(times_of({1.0, 1.01, 3.0, 0.2}));
  std::size_t count = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    count += bins[i].count;
    EXPECT_NEAR(bins[i].high / bins[i].low, std::pow(10.0, 0.05), 1e-9);
    EXPECT_EQ(bins[i].low, i > 0 ? bins[i - 1].high : bins[i].low);
  }
  EXPECT_EQ(count, 4u);
  EXPECT_LE(bins.front().low, 0.2);
  EXPECT_EQ(bins.front().count, 1u);
  EXPECT_GT(bins.back().high, 3.0);
  EXPECT_EQ(bins.back().count, 1u);
  EXPECT_TRUE(histogram({}).empty());
}

TEST(Figure, EmptyPanelsAreLeftOutAndTextIsEscaped) {
  Figure figure = {"a < b & c", "x", "y", {}};
  figure.panels.push_back({"empty", {{"nothing", {}}}});
  EXPECT_EQ(to_svg(figure).find("polyline stroke"), std::string::npos);
  figure.panels.push_back({"full", {{"line", {{1.0, 10.0}, {100.0, 1000.0}}}}});
  const std::string svg = to_svg(figure);
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(svg.find(">empty<"), std::string::npos);
  EXPECT_NE(svg.find(">full<"), std::string::npos);
  // two decades of x over the panel: from its left edge to its right one
  EXPECT_NE(svg.find("points=\"62.0,248.0 414.0,84.0 \""), std::string::npos) << svg;
}

TEST(Figure, MarkersTellLinesThatCoincideApart) {
  Figure figure = {
      "", "x", "y", {{"full", {{"a", {{1.0, 1.0}, {2.0, 2.0}}}, {"b", {{1.0, 1.0}}}}}}};
  const auto count = [&](const char* what) {
    const std::string svg = to_svg(figure);
    int found = 0;
    for (auto at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<path"), 0);
  figure.has_markers = true;
  EXPECT_EQ(count("<path"), 5);       // one per point, one per line of the legend
  EXPECT_EQ(count("d=\"M-5,0A"), 3);  // of the first line only
}

TEST(Csv, HasOneLineOfKeysAndQuotesWhatNeedsIt) {
  const nlohmann::ordered_json rows = {{{"set", "a, b"}, {"us", 1.5}, {"wrong", nullptr}},
                                       {{"set", "say \"c\""}, {"us", 2}, {"wrong", 3}}};
  EXPECT_EQ(to_csv(rows), "set,us,wrong\n\"a, b\",1.5,\n\"say \"\"c\"\"\",2,3\n");
  EXPECT_EQ(to_csv(nlohmann::ordered_json::array()), "");
}

}  // namespace
}  // namespace hg::bench
