#include "ethercat/drive_link.hpp"

#include <algorithm>

namespace pmg::ethercat {

DriveLink::DriveLink(const std::vector<int>& nodes) : in_(2 * nodes.size()) {
  for (const int node : nodes) drives_.push_back({.node = static_cast<std::uint32_t>(node)});
}

std::size_t DriveLink::send(std::span<const drives::Message> frames) noexcept {
  for (const drives::Message& frame : frames) {
    ++counts_.sent;
    if (frame.id == drives::canopen::kSync && frame.length == 0) {
      in_first_ = in_count_ = 0;
      for (Drive& drive : drives_) drive.asked = true;
      continue;
    }
    const auto drive = std::ranges::find_if(
        drives_, [&](const Drive& one) { return frame.id == drives::canopen::kReceive1 + one.node; });
    if (drive == drives_.end() || frame.length != kDriveOutputs) continue;
    std::copy_n(frame.data.begin(), kDriveOutputs, drive->targets.begin());
  }
  return frames.size();
}

std::size_t DriveLink::receive(std::span<drives::Message> frames) noexcept {
  const std::size_t count = std::min(frames.size(), in_count_ - in_first_);
  std::copy_n(in_.begin() + static_cast<std::ptrdiff_t>(in_first_), count, frames.begin());
  in_first_ += count;
  counts_.received += count;
  return count;
}

void DriveLink::take(std::size_t at, std::span<const std::uint8_t> inputs) noexcept {
  Drive& drive = drives_[at];
  const bool whole = inputs.size() == drive_inputs(false) || inputs.size() == drive_inputs(true);
  if (!drive.asked || !whole || in_count_ + 2 > in_.size()) return;
  drive.asked = false;
  in_[in_count_++] = drives::Message::of(drives::canopen::kTransmit1 + drive.node, inputs.first(kFirstInputs));
  in_[in_count_++] = drives::Message::of(drives::canopen::kTransmit2 + drive.node, inputs.subspan(kFirstInputs));
}

void DriveLink::fill(std::size_t at, std::span<std::uint8_t> outputs) const noexcept {
  std::ranges::copy_n(drives_[at].targets.begin(), static_cast<std::ptrdiff_t>(std::min(outputs.size(), kDriveOutputs)),
                      outputs.begin());
}

}  // namespace pmg::ethercat
