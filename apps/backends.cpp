#include "backends.hpp"

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
  factory.lacks("can", "CAN backend");
  factory.lacks("ethercat", "EtherCAT backend");
  return factory;
}

}  // namespace pmg::apps
