#include "hg/experiments/runs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/error.h"

namespace hg::experiments {
namespace {

// Seven and four runs, the latter two by two.
std::vector<nlohmann::json> runs_of(Runs& runs, std::vector<std::size_t>* played = nullptr) {
  std::vector<nlohmann::json> all = runs.next(7, [&](std::size_t i) {
    if (played) played->push_back(i);
    return nlohmann::json(10 + i);
  });
  const auto more = runs.next(
      4,
      [&](std::size_t i) {
        if (played) played->push_back(100 + i);
        return nlohmann::json(20 + i);
      },
      2);
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(Runs, PartsTogetherAreTheWhole) {
  Runs whole;
  const std::vector<nlohmann::json> expected = runs_of(whole);
  for (const std::size_t count : {1u, 2u, 3u, 20u}) {
    std::map<std::size_t, nlohmann::json> results;
    for (std::size_t index = 1; index <= count; ++index) {
      Runs part(Part{index, count});
      runs_of(part);
      for (const auto& [number, result] : part.results()) {
        EXPECT_TRUE(results.emplace(number, result).second) << number << " was played twice";
      }
    }
    Runs merged(results);
    std::vector<std::size_t> played;
    EXPECT_EQ(runs_of(merged, &played), expected);
    EXPECT_TRUE(played.empty());
  }
}

TEST(Runs, WhatBelongsTogetherIsPlayedByOnePart) {
  for (std::size_t index = 1; index <= 3; ++index) {
    Runs part(Part{index, 3});
    std::vector<std::size_t> played;
    runs_of(part, &played);
    for (const std::size_t first : {100u, 102u}) {
      EXPECT_EQ(std::ranges::count(played, first), std::ranges::count(played, first + 1));
    }
  }
}

TEST(Runs, UnitsArePlayedOnceInTheirOrderAndWhatJsonHasNotIsNull) {
  Runs whole;
  std::vector<std::size_t> orders(8);
  const std::vector<nlohmann::json> found = whole.next(
      8,
      [&](std::size_t i) {
        orders[i] = i % 2 == 0 ? 1 : orders[i - 1] + 1;
        return nlohmann::json(i == 3 ? std::nan("") : static_cast<double>(i));
      },
      2);
  EXPECT_EQ(orders, (std::vector<std::size_t>{1, 2, 1, 2, 1, 2, 1, 2}));
  EXPECT_TRUE(found[3].is_null());
  EXPECT_EQ(found[7], 7.0);
}

TEST(Runs, AMissingResultIsNoResult) {
  Runs some(std::map<std::size_t, nlohmann::json>{{0, 10}});
  EXPECT_THROW(runs_of(some), SetupError);
  EXPECT_TRUE(std::isnan(number_of(nullptr)));
  EXPECT_EQ(number_of(1.5), 1.5);
}

}  // namespace
}  // namespace hg::experiments
