#include "campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <mutex>
#include <stdexcept>

#include "asked_for.hpp"
#include "bench_files.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "dormand_prince.hpp"
#include "files.hpp"
#include "files/config_error.hpp"
#include "prepared_plant.hpp"
#include "work/parallel.hpp"

namespace pmg::literature {

namespace {

using nlohmann::json;

diagnosis::Diagnosis diagnose(const std::filesystem::path& bench, const model::ActuatorParameters& base) {
  diagnosis::DiagnoseOptions options;
  options.fit = kFitFilter;
  options.score = kScoreFilter;
  options.model = base;
  return diagnosis::diagnose(bench::read_bench(bench), options);
}

json kept(const diagnosis::Diagnosis& found) {
  json all = diagnosis::diagnosis_json(found);
  for (const char* key : {"rejected", "options", "next_excitation"}) all.erase(key);
  return all;
}

/// With the recordings that the diagnosis asked for; null if it asked for none, or if they are no data of a joint.
json diagnose_again(const diagnosis::Diagnosis& found, const PreparedPlant& prepared,
                    const std::filesystem::path& folder) {
  if (found.verdict != evidence::Verdict::kAmbiguous || !found.next_excitation) return nullptr;
  const LiteraturePlant plant = with_asked_runs(prepared.plant, *found.next_excitation);
  try {
    write_bench(folder, plant, plant.machine, 0, true);
    return kept(diagnose(folder, prepared.base));
  } catch (const files::ConfigError&) {  // the joint ran away under what was asked for
  } catch (const DoesNotConverge&) {
  }
  return nullptr;
}

/// Drops what a killed campaign left after the last whole line.
void mend(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::size_t end = text.rfind('\n');
  std::filesystem::resize_file(file, end == std::string::npos ? 0 : end + 1);
}

std::uint64_t seed_of(const json& result) { return result.at("truth").at("seed").get<std::uint64_t>(); }

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<std::uint64_t> seeds_for(Use use, std::uint64_t first, std::uint64_t last) {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    if ((seed % 2 == 1) == (use == Use::kFinal)) seeds.push_back(seed);
  }
  return seeds;
}

json examine(std::uint64_t seed, const std::filesystem::path& folder, bool keep) {
  const double begin_s = thread_seconds();
  const PreparedPlant prepared = prepare(seed, folder);
  const double prepared_s = thread_seconds() - begin_s;
  json result = {{"truth", prepared.truth}, {"prepared_s", prepared_s}};
  std::optional<diagnosis::Diagnosis> found;
  try {
    found = diagnose(prepared.bench, prepared.base);
    result["diagnosis"] = kept(*found);
  } catch (const files::ConfigError& error) {
    result["diagnosis"] = {{"verdict", "refused"}, {"causes", json::array()}, {"error", error.what()}};
  }
  result["seconds"] = thread_seconds() - begin_s - prepared_s;
  if (found) result["asked"] = diagnose_again(*found, prepared, folder / "asked");
  if (!keep) std::filesystem::remove_all(folder);
  return result;
}

std::vector<json> read_results(const std::filesystem::path& file) {
  std::vector<json> results;
  std::ifstream stream(file);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (stream.eof()) break;  // no end of line: the rest of a killed campaign
    try {
      results.push_back(json::parse(line));
      seed_of(results.back());
    } catch (const json::exception&) {
      throw std::runtime_error(
          fmt::format("{}:{}: no result of a plant; expected a line that run wrote", file.string(), number));
    }
  }
  std::sort(results.begin(), results.end(), [](const json& a, const json& b) { return seed_of(a) < seed_of(b); });
  return results;
}

void run(const Campaign& campaign, const std::vector<std::uint64_t>& seeds) {
  std::set<std::uint64_t> done;
  for (const json& result : read_results(campaign.results)) {
    const std::uint64_t seed = seed_of(result);
    if (!seeds.empty() && seed % 2 != seeds.front() % 2) {
      throw std::invalid_argument(
          fmt::format("{} has seed {}; even and odd seeds don't go into one file", campaign.results.string(), seed));
    }
    done.insert(seed);
  }
  std::vector<std::uint64_t> left;
  std::copy_if(seeds.begin(), seeds.end(), std::back_inserter(left),
               [&](std::uint64_t s) { return !done.contains(s); });
  if (campaign.results.has_parent_path()) std::filesystem::create_directories(campaign.results.parent_path());
  mend(campaign.results);
  std::mutex mutex;
  const auto one = [&](std::size_t index) {
    const std::filesystem::path folder = campaign.results.string() + fmt::format(".plants/{:03}", left[index]);
    const json result = examine(left[index], folder, campaign.keep);
    const std::lock_guard lock(mutex);
    std::ofstream stream(campaign.results, std::ios::app);
    stream << result.dump() + '\n';
    stream.close();
    if (!stream) throw std::runtime_error(campaign.results.string() + " cannot be written");
    if (campaign.each) campaign.each(result);
  };
  work::Progress progress;
  progress.interrupted = campaign.interrupted;
  work::for_each_in_parallel(left.size(), campaign.workers, one, progress);
  if (!campaign.keep) std::filesystem::remove_all(campaign.results.string() + ".plants");
}

}  // namespace pmg::literature
