// literature_plants: benches of joints written from the literature, diagnosed blind; how often the diagnosis is right.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <mutex>
#include <sstream>

#include "apps/program.hpp"
#include "campaign.hpp"
#include "campaign_report.hpp"
#include "fault_examination.hpp"
#include "forms_table.hpp"
#include "io/whole_file.hpp"
#include "prepared_plant.hpp"
#include "promise.hpp"
#include "work/parallel.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kBroken = 1, kInterrupted = 130 };

constexpr const char* kFooter = R"(
Examples:
  literature_plants make --seeds 2:4 --out out/literature    # benches with truth.json and base.yaml beside them
  literature_plants run --seeds 0:199 --workers 2 --out out/even.jsonl
  literature_plants report out/even.jsonl
  literature_plants faults out/literature --seeds 2:4        # the search for data faults alone
  literature_plants forms                                    # every form with its source

Even seeds only; with --final odd seeds only, which nobody looks at before the final report.
Exit codes: 0 done, 1 a rate is out of the question for what --likely asks, 2 bad input, 130 interrupted (run goes on from there).)";

struct Arguments {
  std::string seeds = "0:60";
  fs::path out, json;
  std::vector<fs::path> results;
  unsigned workers = 1;
  bool final = false, keep = false, again = false;
  std::vector<std::string> likely, occurs, strata;
};

/// "0:8,20,26:28" => those of the use that it asks for.
std::vector<std::uint64_t> chosen_seeds(const Arguments& arguments) {
  const literature::Use use = arguments.final ? literature::Use::kFinal : literature::Use::kDevelopment;
  std::vector<std::uint64_t> all;
  try {
    std::istringstream parts(arguments.seeds);
    for (std::string part; std::getline(parts, part, ',');) {
      const std::size_t colon = part.find(':');
      const std::uint64_t first = std::stoul(part),
                          last = colon == std::string::npos ? first : std::stoul(part.substr(colon + 1));
      if (last < first) throw std::invalid_argument("");
      const std::vector<std::uint64_t> seeds = literature::seeds_for(use, first, last);
      all.insert(all.end(), seeds.begin(), seeds.end());
    }
    if (all.empty()) throw std::invalid_argument("");
  } catch (const std::logic_error&) {
    throw std::invalid_argument(
        fmt::format("--seeds {}; expected seeds and FIRST:LAST, as in 0:60 or 0:8,20", arguments.seeds));
  }
  std::erase_if(all, [&](std::uint64_t seed) {
    const std::string stratum = literature::name(literature::stratum_of(seed));
    return !arguments.strata.empty() && std::ranges::find(arguments.strata, stratum) == arguments.strata.end();
  });
  return all;
}

int make(const Arguments& arguments) {
  for (const std::uint64_t seed : chosen_seeds(arguments)) {
    if (apps::interrupt_requested != 0) return kInterrupted;
    const nlohmann::json truth = literature::prepare(seed, arguments.out / fmt::format("{:03}", seed)).truth;
    std::cout << fmt::format("{:3} {:7} {:13} floor {:.2f}, healthy {:.2f} mrad; {}\n", seed,
                             truth.at("kind").get<std::string>(), truth.at("law").get<std::string>(),
                             1e3 * truth.at("noise_floor_rad").get<double>(),
                             1e3 * truth.at("healthy_error_rad").get<double>(), literature::planted_text(truth))
              << std::flush;
  }
  return kOk;
}

int run(const Arguments& arguments) {
  literature::Campaign campaign{.results = arguments.out, .workers = arguments.workers, .keep = arguments.keep};
  campaign.interrupted = [] { return apps::interrupt_requested != 0; };
  campaign.each = [](const nlohmann::json& result) {
    const literature::Judgement j = literature::judge(result);
    std::cout << fmt::format("{:3} {:7} planted {}; said {}: {} ({:.1f} s)\n", j.score.seed, j.score.kind,
                             j.planted.empty() ? "nothing" : j.planted, j.said,
                             !j.counts ? "weak"
                             : j.right ? "right"
                                       : "wrong",
                             j.score.seconds)
              << std::flush;
  };
  const std::vector<std::uint64_t> seeds = chosen_seeds(arguments);
  if (arguments.again) fs::remove(arguments.out);
  literature::run(campaign, seeds);
  return apps::interrupt_requested != 0 ? kInterrupted : kOk;
}

/// "clean kept clean >= 0.95" or "found with a false cause <= 0.1".
bool likely(const literature::CampaignReport& report, const std::string& demand) {
  const std::size_t at = std::min(demand.find(" >= "), demand.find(" <= "));
  if (at == std::string::npos) {
    throw std::invalid_argument(fmt::format("--likely '{}'; expected NAME >= SHARE or NAME <= SHARE", demand));
  }
  const literature::Rate& rate = literature::rate(report, demand.substr(0, at));
  const literature::Promise promise{rate.what, demand[at + 1] == '>', std::stod(demand.substr(at + 4)), rate.kept,
                                    rate.of};
  if (rate.of > 0 && promise.is_likely()) return true;
  std::cerr << fmt::format("{}: {} of {}; {} {} is unlikely\n", rate.what, rate.kept, rate.of,
                           promise.at_least ? "at least" : "at most", promise.promised);
  return false;
}

int report(const Arguments& arguments) {
  std::vector<literature::Judgement> judgements;
  for (const fs::path& file : arguments.results) {
    const std::vector<nlohmann::json> results = literature::read_results(file);
    if (results.empty()) throw std::runtime_error(file.string() + ": no results; expected a file that run wrote");
    for (const nlohmann::json& result : results) judgements.push_back(literature::judge(result));
  }
  const literature::CampaignReport report = literature::report_of(std::move(judgements));
  std::cout << literature::markdown(report);
  if (!arguments.json.empty()) io::write_whole_file(arguments.json, literature::report_json(report).dump(1) + "\n");
  bool all = true;
  for (const std::string& demand : arguments.likely) all = likely(report, demand) && all;
  for (const std::string& what : literature::absent(report, arguments.occurs)) {
    std::cerr << fmt::format("no plant is {}; expected at least one\n", what);
    all = false;
  }
  return all ? kOk : kBroken;
}

int faults(const Arguments& arguments) {
  std::vector<fs::path> folders;
  for (const std::uint64_t seed : chosen_seeds(arguments)) {
    const fs::path folder = arguments.out / fmt::format("{:03}", seed);
    if (fs::exists(folder / "truth.json")) folders.push_back(folder);
  }
  if (folders.empty()) throw std::invalid_argument(arguments.out.string() + ": none of these plants; run make first");
  std::vector<literature::ExaminedPlant> plants(folders.size());
  std::mutex mutex;
  work::Progress progress;
  progress.interrupted = [] { return apps::interrupt_requested != 0; };
  const auto examine = [&](std::size_t i) {
    plants[i] = literature::examine_faults(folders[i]);
    const std::lock_guard lock(mutex);
    std::cout << literature::examined_text(plants[i]) << '\n' << std::flush;
  };
  work::for_each_in_parallel(folders.size(), arguments.workers, examine, progress);
  if (apps::interrupt_requested != 0) return kInterrupted;
  std::cout << '\n' << literature::fault_tables(plants);
  return kOk;
}

int forms() {
  std::cout << literature::forms_table();
  return kOk;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Benches of joints written from the literature, diagnosed blind.", "literature_plants");
  app.footer(kFooter);
  app.require_subcommand(1);
  Arguments arguments;
  const auto of_seeds = [&](const char* name, const char* text) {
    CLI::App* command = app.add_subcommand(name, text);
    command->add_option("--seeds", arguments.seeds, "seeds and FIRST:LAST, with commas between; of these the even ones")
        ->capture_default_str();
    command->add_option("--stratum", arguments.strata, "of these only single, double, clean, strange or fault")
        ->check(CLI::IsMember({"single", "double", "clean", "strange", "fault"}));
    command->add_flag("--final", arguments.final, "the odd ones instead: for the final report, never to develop on");
    return command;
  };
  CLI::App* make_command = of_seeds("make", "write benches and their truth");
  make_command->add_option("--out", arguments.out, "folder; made if absent")->required();
  CLI::App* run_command = of_seeds("run", "diagnose; seeds that have a result already are left");
  run_command->add_option("--out", arguments.out, "file to which a line a plant is appended")->required();
  run_command->add_option("--workers", arguments.workers, "threads")->capture_default_str()->check(CLI::Range(1, 64));
  run_command->add_flag("--again", arguments.again, "drop the file's results first");
  run_command->add_flag("--keep", arguments.keep, "keep the benches, in OUT.plants");
  CLI::App* report_command = app.add_subcommand("report", "what the results amount to");
  report_command->add_option("RESULTS", arguments.results, "files that run wrote")->required();
  report_command->add_option("--json", arguments.json, "write it for machines, too");
  report_command->add_option("--likely", arguments.likely,
                             "fail if a row's count is out of the question for that share: 'clean kept clean >= 0.95'");
  report_command->add_option(
      "--occurs", arguments.occurs,
      "fail unless a plant of this stratum counts, or a diagnosis says this verdict: double, fault, found ...");
  CLI::App* faults_command = of_seeds("faults", "search for data faults alone in plants that make wrote");
  faults_command->add_option("PLANTS", arguments.out, "folder that make wrote")->required();
  faults_command->add_option("--workers", arguments.workers, "threads")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  CLI::App* forms_command = app.add_subcommand("forms", "every form with its source");
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM});
    if (forms_command->parsed()) return forms();
    if (faults_command->parsed()) return faults(arguments);
    return make_command->parsed() ? make(arguments) : run_command->parsed() ? run(arguments) : report(arguments);
  });
}
