// Foxglove's published JSON schemas of the messages that foxglove_topics.hpp writes.
#pragma once

namespace pmg::topics {

extern const char* const kFrameTransformsSchema;
extern const char* const kJointStatesSchema;
extern const char* const kLogSchema;

}  // namespace pmg::topics
