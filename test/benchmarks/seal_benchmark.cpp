// What authentication costs the comms thread: reported, not gated. In a second of driving it judges some 70 operators'
// messages and proves 100 STATUS messages and some ACKs.
#include <benchmark/benchmark.h>

#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "seal/controller_seal.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::seal {
namespace {

struct Bench {
  Secret secret = random_secret();
  ControllerKeys keys{.own = random_secret(), .operators = {{"anna", secret}}};
  ControllerSeal controller{keys};
  OperatorSeal anna{{{"anna", Signer(keys.own).public_key(), secret}}, false};
  pmg_msgs::status_t status{};
  pmg_msgs::command_t command{};
  std::vector<std::uint8_t> sealed;
  Peer peer;

  Bench() {
    status.robot = command.robot = "z1";
    command.source = "anna.12345";
    const auto proven = decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(controller.prove("STATUS", status));
    peer = anna.believe("STATUS", proven->message_bytes, proven->seal, 0).value();
    const io::Bytes bytes = anna.seal("COMMAND", command, &peer);
    sealed.assign(bytes.begin(), bytes.end());
  }
};

void BM_judge_command(benchmark::State& state) {
  const Bench bench;
  for (auto _ : state) {
    const auto message = decode_sealed<pmg_msgs::command_t, pmg_msgs::seal_t>(bench.sealed);
    auto judgement = bench.controller.judge("COMMAND", "anna.12345", message->message_bytes, message->seal, 0);
    benchmark::DoNotOptimize(judgement);
  }
}
BENCHMARK(BM_judge_command);

void BM_prove_status(benchmark::State& state) {
  Bench bench;
  for (auto _ : state) benchmark::DoNotOptimize(bench.controller.prove("STATUS", bench.status).data());
}
BENCHMARK(BM_prove_status);

/// looks: how many parts of the program look at each STATUS, in which no two are alike.
void BM_believe_status(benchmark::State& state) {
  Bench bench;
  std::vector<std::vector<std::uint8_t>> said;
  for (int k = 0; k < 256; ++k) {
    ++bench.status.stamp_ns;
    const io::Bytes bytes = bench.controller.prove("STATUS", bench.status);
    said.emplace_back(bytes.begin(), bytes.end());
  }
  std::int64_t now_ns = 0;
  for (auto _ : state) {
    now_ns += 10'000'000;
    const auto& bytes = said[static_cast<std::size_t>(now_ns / 10'000'000) % said.size()];
    for (std::int64_t look = 0; look < state.range(0); ++look) {
      const auto proven = decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
      auto peer = bench.anna.believe("STATUS", proven->message_bytes, proven->seal, now_ns);
      benchmark::DoNotOptimize(peer);
    }
  }
}
BENCHMARK(BM_believe_status)->ArgName("looks")->Arg(1)->Arg(2);

void BM_digest_of_request(benchmark::State& state) {
  const std::vector<std::uint8_t> request(100, 7);
  for (auto _ : state) benchmark::DoNotOptimize(digest_of(request));
}
BENCHMARK(BM_digest_of_request);

}  // namespace
}  // namespace pmg::seal

BENCHMARK_MAIN();
