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
    peer = anna.believe("STATUS", proven->message_bytes, proven->seal).value();
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

void BM_believe_status(benchmark::State& state) {
  Bench bench;
  const io::Bytes bytes = bench.controller.prove("STATUS", bench.status);
  for (auto _ : state) {
    const auto proven = decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
    auto peer = bench.anna.believe("STATUS", proven->message_bytes, proven->seal);
    benchmark::DoNotOptimize(peer);
  }
}
BENCHMARK(BM_believe_status);

}  // namespace
}  // namespace pmg::seal

BENCHMARK_MAIN();
