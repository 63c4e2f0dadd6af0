#include "backends.hpp"

#include "can/can_backend.hpp"

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
  factory.lacks("ethercat", "EtherCAT backend");
  return factory;
}

}  // namespace pmg::apps
