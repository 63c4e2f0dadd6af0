#include "tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

namespace pmg::hidden {

namespace {

using Value = nlohmann::json;

constexpr double kPromisedWidth = 0.25;

Promise promise(const std::string& what, double promised, const std::vector<Score>& scores, auto counts, auto keeps) {
  Promise p{what, true, promised};
  for (const Score& s : scores) {
    if (!counts(s)) continue;
    ++p.of;
    if (keeps(s)) ++p.kept;
  }
  return p;
}

std::vector<Promise> promises(const std::vector<Score>& scores) {
  const auto from_catalogue = [](const Score& s) { return s.strong && s.kind != "strange"; };
  std::vector<Promise> all;
  all.push_back(promise("named", 0.90, scores, from_catalogue, [](const Score& s) { return s.named; }));
  all.push_back(promise("verdict ambiguous", 0.15, scores, from_catalogue, [](const Score& s) { return s.ambiguous; }));
  all.back().at_least = false;
  all.push_back(promise(
      "settled by the excitation asked for", 0.80, scores,
      [&](const Score& s) { return from_catalogue(s) && s.ambiguous; }, [](const Score& s) { return s.settled; }));
  all.push_back(promise(
      "clean: no false cause", 0.95, scores, [](const Score& s) { return s.kind == "clean"; },
      [](const Score& s) { return !s.accused; }));
  all.push_back(promise(
      "off the catalogue: unexplained", 0.80, scores, [](const Score& s) { return s.strong && s.kind == "strange"; },
      [](const Score& s) { return s.verdict == "unexplained"; }));
  Promise inside{"parameters in their intervals", true, 0.85};
  for (const Score& s : scores) {
    for (const ScoredParameter& p : s.parameters) {
      ++inside.of;
      if (p.inside()) ++inside.kept;
    }
  }
  all.push_back(inside);
  return all;
}

double median_width(const std::vector<Score>& scores) {
  std::vector<double> widths;
  for (const Score& s : scores) {
    for (const ScoredParameter& p : s.parameters) widths.push_back(p.width());
  }
  if (widths.empty()) return 0.0;
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  return *middle;
}

bool right(const Score& s) {
  return s.kind == "clean" ? !s.accused : s.kind == "strange" ? s.verdict == "unexplained" : s.named;
}

/// Of each effect: planted strongly, named, ambiguous, and what was said instead.
std::string by_effect(const std::vector<Score>& scores) {
  struct Row {
    int strong = 0, named = 0, ambiguous = 0;
    std::map<std::string, int> instead;
  };
  std::map<std::string, Row> rows;
  for (const Score& s : scores) {
    if (s.kind == "double" || (s.kind != "clean" && !s.strong)) continue;
    Row& row = rows[s.kind == "clean" ? "nothing" : s.planted.substr(0, s.planted.find(' '))];
    ++row.strong;
    row.named += right(s) ? 1 : 0;
    row.ambiguous += s.ambiguous ? 1 : 0;
    if (!right(s)) ++row.instead[s.said];
  }
  std::string text = "| planted | plants | right | of these ambiguous | said instead |\n|---|---|---|---|---|\n";
  for (const auto& [name, row] : rows) {
    std::string instead;
    for (const auto& [said, count] : row.instead) {
      instead += (instead.empty() ? "" : "; ") + said + (count > 1 ? fmt::format(" ({})", count) : "");
    }
    text += fmt::format("| {} | {} | {} | {} | {} |\n", name, row.strong, row.named, row.ambiguous, instead);
  }
  return text;
}

}  // namespace

Tally tally(const std::filesystem::path& results) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(results)) {
    for (const auto& entry : std::filesystem::directory_iterator(results)) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
  }
  if (files.empty()) throw std::runtime_error(results.string() + ": no results; expected *.json of a campaign");
  Tally tally;
  for (const std::filesystem::path& file : files) {
    std::ifstream stream(file);
    tally.scores.push_back(score(Value::parse(stream)));
  }
  std::sort(tally.scores.begin(), tally.scores.end(), [](const Score& a, const Score& b) { return a.seed < b.seed; });
  tally.promises = promises(tally.scores);
  tally.median_width = median_width(tally.scores);
  return tally;
}

std::string markdown(const Tally& tally) {
  std::string text = "| | promised | kept | of | share |\n|---|---|---|---|---|\n";
  for (const Promise& p : tally.promises) {
    text += fmt::format("| {} | {} {:.0f} % | {} | {} | {} |\n", p.what, p.at_least ? "at least" : "at most",
                        100.0 * p.promised, p.kept, p.of, p.of == 0 ? "" : fmt::format("{:.1f} %", 100.0 * p.share()));
  }
  text += fmt::format("| median width of the intervals | at most {:.0f} % | | | {:.1f} % |\n\n", 100.0 * kPromisedWidth,
                      100.0 * tally.median_width);
  text += by_effect(tally.scores) + "\n";
  text += "| seed | kind | planted (noise floors) | said | right | s |\n|---|---|---|---|---|---|\n";
  for (const Score& s : tally.scores) {
    const char* mark = s.kind != "clean" && !s.strong ? "weak" : right(s) ? "yes" : "no";
    text += fmt::format("| {} | {} | {} | {} | {}{} | {:.1f} |\n", s.seed, s.kind, s.planted, s.said, mark,
                        s.settled ? ", settled" : "", s.seconds);
  }
  return text;
}

nlohmann::ordered_json json(const Tally& tally) {
  using Json = nlohmann::ordered_json;
  Json promises = Json::array(), plants = Json::array();
  for (const Promise& p : tally.promises) {
    promises.push_back(
        {{"what", p.what}, {"at_least", p.at_least}, {"promised", p.promised}, {"kept", p.kept}, {"of", p.of}});
  }
  for (const Score& s : tally.scores) {
    plants.push_back({{"seed", s.seed},
                      {"kind", s.kind},
                      {"planted", s.planted},
                      {"said", s.said},
                      {"counts", s.kind == "clean" || s.strong},
                      {"right", right(s)},
                      {"settled", s.settled}});
  }
  return {{"promises", promises}, {"median_interval_width", tally.median_width}, {"plants", plants}};
}

}  // namespace pmg::hidden
