// The controller's side: judges the seals of operators' messages, and proves that its own messages are its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "pmg_msgs/proof_t.hpp"
#include "pmg_msgs/seal_t.hpp"
#include "seal/key_files.hpp"
#include "seal/sealed_message.hpp"

namespace pmg::seal {

/// For one ordinary thread. A seal is good for kFresh_ns after the STATUS that it names, by this controller's clock,
/// and for this start of the controller only. So what was recorded earlier is refused, whatever its numbers are and
/// whoever is remembered.
class ControllerSeal {
 public:
  static constexpr std::int64_t kFresh_ns = 1'000'000'000;

  enum class Judgement {
    kGood,
    kNotFresh,  ///< no seal, another version, another start, or sealed too long ago
    kNoKey,     ///< no key of ours, its code is wrong, or the source is not its operator's
  };

  /// keys: nothing: everybody on the network may drive. folder: where the keys are, for refresh().
  explicit ControllerSeal(std::optional<ControllerKeys> keys = std::nullopt, std::filesystem::path folder = {});

  std::int64_t boot() const noexcept { return boot_; }
  bool has_keys() const noexcept { return keys_.has_value(); }
  /// Operators' keys that are in force from now on.
  void set_operators(std::map<std::string, Secret> operators);
  /// Reads the operators' keys again: keys that were made or revoked, files that were damaged or that others may read.
  /// If they can't be read, none is in force. Returns a line that says so, once for each change.
  std::string refresh();

  /// source: the message's.
  Judgement judge(std::string_view channel, std::string_view source, io::Bytes message,
                  const std::optional<pmg_msgs::seal_t>& seal, std::int64_t now_ns) const;

  /// (message) => message and proof, for LcmLink::send(). Valid until the next call.
  template <typename Message>
  io::Bytes prove(std::string_view channel, const Message& message) {
    buffer_.clear();
    append(buffer_, message);
    append_proof(channel);
    return buffer_;
  }

  /// Whether this message is of a controller with our own key; without keys: of any.
  bool ours(std::string_view channel, io::Bytes message, const std::optional<pmg_msgs::proof_t>& proof) const;

 private:
  void append_proof(std::string_view channel);

  std::optional<ControllerKeys> keys_;
  std::filesystem::path folder_;
  std::string trouble_;  // that was told last
  std::optional<Signer> signer_;
  PublicKey public_key_{};
  std::int64_t boot_;
  std::vector<std::uint8_t> buffer_;
};

/// (folder of keys, address) => the controller's seal. folder: empty: controller_folder() where messages leave this
/// computer, and no keys elsewhere. insecure: a network without keys is wanted. Throws std::runtime_error when keys are
/// missing: one line that says how to make one.
ControllerSeal load_controller_seal(const std::string& folder, const std::string& lcm_url, bool insecure);

}  // namespace pmg::seal
