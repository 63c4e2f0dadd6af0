#include "seal/operator_seal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace pmg::seal {

OperatorSeal::OperatorSeal(std::vector<OperatorKey> keys, bool believes_unsigned)
    : verifier_(std::make_shared<Verifier>(std::move(keys))), believes_unsigned_(believes_unsigned) {}

std::string OperatorSeal::source_name(std::string_view program) const {
  const auto& keys = verifier_->keys();
  return fmt::format("{}.{}", keys.empty() ? program : std::string_view(keys.front().name), ::getpid());
}

std::optional<Peer> OperatorSeal::believe(std::string_view channel, io::Bytes message,
                                          const std::optional<pmg_msgs::proof_t>& proof, std::int64_t now_ns) const {
  Peer peer;
  if (proof) {
    peer.boot = proof->boot;
    peer.wants_key = !proof->signature.empty();
    pmg_msgs::proof_t bare = *proof;
    bare.signature_size = 0;
    bare.signature.clear();
    if (peer.wants_key && !verifier_->keys().empty()) {
      peer.key = verifier_->signer(proof->boot, authenticated_bytes(channel, message, bare), proof->signature, now_ns);
    }
  }
  if (!peer.key && !believes_unsigned_) return std::nullopt;
  return peer;
}

void OperatorSeal::append_seal(std::string_view channel, const Peer& peer) {
  pmg_msgs::seal_t seal{};
  seal.version = pmg_msgs::seal_t::VERSION;
  seal.boot = peer.boot;
  seal.heard_ns = peer.heard_ns;
  if (peer.key) {
    const OperatorKey& key = verifier_->keys()[*peer.key];
    seal.key = key.name;
    const Code code = code_of(key.secret, authenticated_bytes(channel, buffer_, seal));
    seal.code.assign(code.begin(), code.end());
    seal.code_size = static_cast<std::int32_t>(code.size());
  }
  append(buffer_, seal);
}

OperatorSeal load_operator_seal(const std::string& folder, const std::string& lcm_url) {
  std::vector<OperatorKey> keys =
      read_operator_keys(folder.empty() ? operator_folder() : std::filesystem::path(folder));
  if (keys.empty() && !folder.empty()) {
    throw std::runtime_error(fmt::format("keys {}: expected a folder with an operator's *.key (pmg_key new)", folder));
  }
  const bool believes_unsigned = keys.empty() || (folder.empty() && !io::leaves_this_computer(lcm_url));
  return {std::move(keys), believes_unsigned};
}

}  // namespace pmg::seal
