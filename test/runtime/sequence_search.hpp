// Every sequence of actions to a depth, over one model.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pmg::runtime::model {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// Every sequence of `depth` actions, each from 0 to actions - 1.
template <typename Run>
void each_sequence(std::size_t actions, std::size_t depth, const Run& run) {
  std::vector<std::size_t> sequence(depth, 0);
  for (;;) {
    if (!run(std::span<const std::size_t>(sequence))) return;
    std::size_t place = 0;
    while (place < depth && ++sequence[place] == actions) sequence[place++] = 0;
    if (place == depth) return;
  }
}

inline std::string trace(std::span<const std::size_t> sequence, std::span<const char* const> names) {
  std::string text;
  for (const std::size_t action : sequence) text += std::string(text.empty() ? "" : ", then ") + names[action];
  return text;
}

/// Runs every sequence; reports the first that shows what should never be.
template <typename Model>
void search(std::size_t depth) {
  std::size_t runs = 0;
  each_sequence(Model::kActions.size(), depth, [&](std::span<const std::size_t> sequence) {
    Model model;
    ++runs;
    for (std::size_t done = 0; done < sequence.size() && model.violation().empty(); ++done) model.act(sequence[done]);
    if (!model.violation().empty()) ADD_FAILURE() << model.violation() << ": " << trace(sequence, Model::kActions);
    return model.violation().empty();
  });
  testing::Test::RecordProperty("sequences", static_cast<int>(runs));
}

}  // namespace pmg::runtime::model
