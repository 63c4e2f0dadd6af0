#include "backends.hpp"

#include "can/can_backend.hpp"

#ifdef PMG_ETHERCAT
#include "ethercat/ethercat_backend.hpp"
#endif
#ifdef PMG_SIL
#include "sil/simulated_backend.hpp"
#endif

namespace pmg::apps {

hal::BackendFactory backends() {
  hal::BackendFactory factory;
#ifdef PMG_SIL
  sil::register_backend(factory);
#else
  factory.lacks("sil", "simulated robot");
#endif
  can::register_backend(factory);
#ifdef PMG_ETHERCAT
  ethercat::register_backend(factory);
#else
  factory.lacks("ethercat", "EtherCAT backend (SOEM: third_party/fetch-soem)");
#endif
  return factory;
}

}  // namespace pmg::apps
