// hidden_plants: benches with a hidden effect, diagnosed blind; how often the diagnosis is right.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "apps/program.hpp"
#include "campaign.hpp"
#include "io/whole_file.hpp"
#include "prepared_plant.hpp"
#include "tally.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kBroken = 1, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kTablesBegin = "<!-- tables, written by hidden_plants -->\n\n";

constexpr const char* kFooter = R"(
Examples:
  hidden_plants make --seeds 3:5 --out out/plants       # benches with truth.json and base.yaml beside them, to look at
  hidden_plants run --seeds 0:199 --shard 1/4 --out out/nightly
  hidden_plants table out/nightly --markdown docs/explanation/hidden-plants.md --require promised

Exit codes: 0 done, 1 a promise is broken, 2 bad input, 130 interrupted (results so far are kept; run goes on from them).)";

struct Arguments {
  std::string seeds = "0:19", shard = "1/1", require = "nothing";
  fs::path out, results, markdown, json;
  bool keep = false, again = false;
};

/// "A:B" or "A/B".
std::pair<std::uint64_t, std::uint64_t> two_numbers(const std::string& text, char between) {
  const std::size_t at = text.find(between);
  try {
    if (at == std::string::npos) throw std::invalid_argument("");
    return {std::stoul(text.substr(0, at)), std::stoul(text.substr(at + 1))};
  } catch (const std::logic_error&) {
    throw std::invalid_argument(fmt::format("'{}'; expected two numbers, as in 1{}4", text, between));
  }
}

std::vector<std::uint64_t> chosen_seeds(const Arguments& arguments) {
  const auto [first, last] = two_numbers(arguments.seeds, ':');
  const auto [shard, shards] = two_numbers(arguments.shard, '/');
  if (last < first || shard < 1 || shard > shards) {
    throw std::invalid_argument(fmt::format("--seeds {} --shard {}; expected FIRST:LAST, and a shard from 1",
                                            arguments.seeds, arguments.shard));
  }
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    if (seed % shards == shard - 1) seeds.push_back(seed);
  }
  return seeds;
}

int make(const Arguments& arguments) {
  for (const std::uint64_t seed : chosen_seeds(arguments)) {
    if (apps::interrupt_requested != 0) return kInterrupted;
    const hidden::PlantedTruth truth = hidden::prepare(seed, arguments.out / fmt::format("{:03}", seed)).truth;
    std::cout << fmt::format("{:3} {:8} floor {:.2f}, healthy {:.2f}, now {:.2f} mrad", seed, hidden::name(truth.kind),
                             1e3 * truth.floor_rad, 1e3 * truth.healthy_error_rad, 1e3 * truth.error_rad);
    for (const auto& effect : truth.effects)
      std::cout << fmt::format("; {} moves {:.1f} floors", effect.name, effect.moves_floors);
    std::cout << '\n' << std::flush;
  }
  return kOk;
}

int run(const Arguments& arguments) {
  fs::create_directories(arguments.out);
  for (const std::uint64_t seed : chosen_seeds(arguments)) {
    if (apps::interrupt_requested != 0) return kInterrupted;
    const fs::path file = arguments.out / fmt::format("{:03}.json", seed);
    if (!fs::exists(file) || arguments.again) {
      const nlohmann::json result =
          hidden::examine(seed, arguments.out / fmt::format("plant-{:03}", seed), arguments.keep);
      io::write_whole_file(file, result.dump(2) + "\n");
    }
    std::ifstream stream(file);
    const hidden::Score score = hidden::score(nlohmann::json::parse(stream));
    std::cout << fmt::format("{:3} {:8} planted {}; said {} ({:.1f} s)", seed, score.kind,
                             score.planted.empty() ? "nothing" : score.planted, score.said, score.seconds)
              << '\n'
              << std::flush;
  }
  return kOk;
}

/// A page keeps what stands before the line at which its tables begin.
std::string on_page(const fs::path& page, const std::string& tables) {
  std::ifstream stream(page);
  const std::string before((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::size_t at = before.find(kTablesBegin);
  return at == std::string::npos ? tables : before.substr(0, at) + kTablesBegin + tables;
}

int table(const Arguments& arguments) {
  const hidden::Tally tally = hidden::tally(arguments.results);
  const std::string text = hidden::markdown(tally);
  if (arguments.markdown.empty())
    std::cout << text;
  else
    io::write_whole_file(arguments.markdown, on_page(arguments.markdown, text));
  if (!arguments.json.empty()) io::write_whole_file(arguments.json, hidden::json(tally).dump(1) + "\n");
  bool kept = true;
  for (const hidden::Promise& p : tally.promises) {
    const bool broken = arguments.require == "promised" ? !p.holds() : !p.is_likely();
    if (arguments.require == "nothing" || !broken) continue;
    std::cerr << fmt::format("broken: {}: {} of {}, promised {} {:.0f} %\n", p.what, p.kept, p.of,
                             p.at_least ? "at least" : "at most", 100.0 * p.promised);
    kept = false;
  }
  return kept ? kOk : kBroken;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Benches with a hidden effect, diagnosed blind.", "hidden_plants");
  app.footer(kFooter);
  app.require_subcommand(1);
  Arguments arguments;
  const auto of_seeds = [&](const char* name, const char* text) {
    CLI::App* command = app.add_subcommand(name, text);
    command->add_option("--seeds", arguments.seeds, "FIRST:LAST")->capture_default_str();
    command->add_option("--shard", arguments.shard, "K/N: every N-th seed only, so that several can run at a time");
    command->add_option("--out", arguments.out, "folder; made if absent")->required();
    return command;
  };
  CLI::App* make_command = of_seeds("make", "write benches and their truth");
  CLI::App* run_command = of_seeds("run", "diagnose; results that are there already stay");
  run_command->add_flag("--keep", arguments.keep, "keep the benches");
  run_command->add_flag("--again", arguments.again, "diagnose what has a result already, too");
  CLI::App* table_command = app.add_subcommand("table", "what the results amount to");
  table_command->add_option("RESULTS", arguments.results, "folder that run wrote")->required();
  table_command->add_option("--markdown", arguments.markdown, "write the table into that page instead of printing it");
  table_command->add_option("--json", arguments.json, "write it for machines, too");
  table_command
      ->add_option("--require", arguments.require,
                   "promised: every share as promised; likely: no share that is out of the question for as few plants")
      ->check(CLI::IsMember({"nothing", "likely", "promised"}));
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT});
    return make_command->parsed() ? make(arguments) : run_command->parsed() ? run(arguments) : table(arguments);
  });
}
