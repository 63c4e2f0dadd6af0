// The pinned ONNX Runtime: library (PyPI wheel) and headers (Debian 13) have different sources and must match.
#include <gtest/gtest.h>
#include <onnxruntime_cxx_api.h>

#include <string>

namespace pmg::test {
namespace {

TEST(OnnxRuntime, LibraryIsThePinnedOneAndOffersTheHeadersApi) {
  const OrtApiBase* base = OrtGetApiBase();
  EXPECT_EQ(std::string(base->GetVersionString()), "1.21.1");
  EXPECT_NE(base->GetApi(ORT_API_VERSION), nullptr);
}

TEST(OnnxRuntime, RefusesBytesThatAreNoModel) {
  const Ort::Env environment(ORT_LOGGING_LEVEL_FATAL, "test");
  Ort::SessionOptions options;
  options.SetIntraOpNumThreads(1);
  const std::string bytes = "not a model";
  EXPECT_THROW(Ort::Session(environment, bytes.data(), bytes.size(), options), Ort::Exception);
}

}  // namespace
}  // namespace pmg::test
