#include <gtest/gtest.h>

#include "pose_graph/made_drive.hpp"

namespace traverse::pose_graph {
namespace {
TEST(PoseGraph, Nothing) { EXPECT_TRUE(PoseGraph().optimise().converged); }
}  // namespace
}  // namespace traverse::pose_graph
