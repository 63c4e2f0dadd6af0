// The operator's side: seals its messages, and tells whether a controller's messages are the controller's.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/lcm_link.hpp"
#include "pmg_msgs/proof_t.hpp"
#include "pmg_msgs/seal_t.hpp"
#include "seal/key_files.hpp"
#include "seal/sealed_message.hpp"
#include "seal/verifier.hpp"

namespace pmg::seal {

/// What an operator knows of one start of a controller.
struct Peer {
  std::int64_t boot = 0;
  std::int64_t heard_ns = 0;       ///< stamp_ns of its newest STATUS
  std::optional<std::size_t> key;  ///< of OperatorSeal's keys; nothing: none fits, or the controller has no keys
  bool wants_key = false;          ///< the controller signs, so it has keys
};

/// For one thread; its copies share their keys and what they have verified.
class OperatorSeal {
 public:
  OperatorSeal() : OperatorSeal({}, true) {}
  /// believes_unsigned: take a controller's word without a signature, too.
  OperatorSeal(std::vector<OperatorKey> keys, bool believes_unsigned);

  /// A name for a source of this process that controllers with our key accept: OPERATOR.PROCESS, or without keys
  /// PROGRAM.PROCESS.
  std::string source_name(std::string_view program) const;

  /// (STATUS, ACK or another message of a controller) => its sender; nothing: not believed. heard_ns is not set. Look
  /// at what costs less first: this takes 0.1 ms, and has a budget.
  std::optional<Peer> believe(std::string_view channel, io::Bytes message,
                              const std::optional<pmg_msgs::proof_t>& proof, std::int64_t now_ns) const;

  /// Signatures that this seal and its copies have looked at.
  std::int64_t signatures_checked() const noexcept { return verifier_->checked(); }

  /// (message) => message and seal, for LcmLink::send(). Valid until the next call. peer: null: without a seal.
  template <typename Message>
  io::Bytes seal(std::string_view channel, const Message& message, const Peer* peer) {
    buffer_.clear();
    append(buffer_, message);
    if (peer != nullptr) append_seal(channel, *peer);
    return buffer_;
  }

  /// Of the message alone, as seal() encodes it: what its answer names.
  template <typename Message>
  Digest digest(const Message& message) {
    buffer_.clear();
    append(buffer_, message);
    return digest_of(buffer_);
  }

 private:
  void append_seal(std::string_view channel, const Peer& peer);

  std::shared_ptr<Verifier> verifier_;
  bool believes_unsigned_;
  std::vector<std::uint8_t> buffer_;
};

/// (an operator's folder of keys, address) => its seal. folder: empty: operator_folder(), which may be missing. Where
/// messages leave this computer, an operator with keys believes signed messages alone. Throws as read_operator_keys()
/// does, and if a folder was given that has no key.
OperatorSeal load_operator_seal(const std::string& folder, const std::string& lcm_url);

}  // namespace pmg::seal
