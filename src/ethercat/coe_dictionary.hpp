// A slave's objects over its mailbox: CANopen over EtherCAT (ETG.1000.6).
#pragma once

#include "drive_protocols/canopen.hpp"
#include "drive_protocols/cia402_objects.hpp"
#include "ethercat/soem_port.hpp"

namespace pmg::ethercat {

class CoeDictionary final : public drives::ObjectDictionary {
 public:
  /// The slave is in pre-operational or above.
  CoeDictionary(ecx_contextt& context, std::uint16_t slave) : context_(context), slave_(slave) {}
  std::optional<std::uint32_t> read(const drives::ObjectId& id) override;
  bool write(const drives::ObjectId& id, std::uint32_t value) override;

 private:
  /// An expedited transfer. Nullopt: there is no such object.
  std::optional<drives::canopen::SdoAnswer> ask(const drives::Message& request, const drives::ObjectId& id);

  ecx_contextt& context_;
  std::uint16_t slave_;
};

/// Maps a drive's process data as drives::canopen's PDOs: RPDO1, and TPDO1 with TPDO2's objects behind it. Throws
/// std::runtime_error.
void map_process_data(drives::ObjectDictionary& dictionary, const drives::Cia402Settings& settings);

}  // namespace pmg::ethercat
