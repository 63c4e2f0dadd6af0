#include "topics/message_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include "io/message_prefix.hpp"
#include "pmg_msgs/message_fields.hpp"
#include "topics/field_gatherer.hpp"

namespace pmg::topics {

namespace {

using io::Bytes;
using Names = std::vector<std::string>;

template <typename Message>
bool read(Bytes data, const Names& joint_names, std::vector<Field>& fields) {
  static thread_local Message message;  // its memory is reused
  if (!io::decode_prefix(data, message)) return false;
  fields.clear();
  FieldGatherer(joint_names, fields).add(message);
  return true;
}

using Read = bool (*)(Bytes, const Names&, std::vector<Field>&);

template <typename... Message>
constexpr std::array<std::string_view, sizeof...(Message)> channels_of(std::type_identity<std::tuple<Message...>>) {
  return {pmg_msgs::kChannel<Message>...};
}
template <typename... Message>
constexpr std::array<Read, sizeof...(Message)> reads_of(std::type_identity<std::tuple<Message...>>) {
  return {read<Message>...};
}
constexpr auto kChannelsInOrder = channels_of(std::type_identity<pmg_msgs::Messages>{});
constexpr auto kReads = reads_of(std::type_identity<pmg_msgs::Messages>{});

struct ToText {
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return fmt::format("{}", value); }
  std::string operator()(bool value) const { return value ? "1" : "0"; }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<std::string>& values) const {
    return fmt::format("{}", fmt::join(values, ";"));
  }
};

}  // namespace

std::string_view Field::constant() const {
  const auto* number = std::get_if<std::int64_t>(&value);
  for (const pmg_msgs::Constant& one : constants) {
    if (number != nullptr && one.value == *number) return one.name;
  }
  return {};
}

std::string to_text(const Field::Value& value) { return std::visit(ToText{}, value); }

std::span<const std::string_view> known_channels() { return kChannelsInOrder; }

bool read_fields(std::string_view channel, Bytes data, const Names& joint_names, std::vector<Field>& fields) {
  for (std::size_t i = 0; i < kChannelsInOrder.size(); ++i) {
    if (channel == kChannelsInOrder[i]) return kReads[i](data, joint_names, fields);
  }
  return false;
}

}  // namespace pmg::topics
