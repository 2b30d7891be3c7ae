#include "traverse/optimization/jacobian_audit.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "traverse/files/json_document.hpp"

#include "optimization/broken_factor.hpp"

namespace traverse::optimization {
namespace {

using testing::turned_point_kind;

JacobianAudit audit_of(const FactorKind& kind) {
  return audit_jacobians(std::vector<FactorKind>{kind}, AuditOptions{});
}

TEST(JacobianAudit, PassesAFactorThatIsRight) {
  const JacobianAudit audit = audit_of(turned_point_kind(Perturbation::kLeft));
  EXPECT_TRUE(audit.passed());
  ASSERT_EQ(audit.factors.size(), 1U);
  EXPECT_GT(audit.factors[0].min_residual, 0.1);
  const BlockAudit& block = audit.factors[0].blocks.at(0);
  EXPECT_TRUE(block.passed);
  EXPECT_GT(block.largest_entry, 5);
  EXPECT_LT(block.automatic.relative, 1e-13);
  EXPECT_LT(block.numeric.relative, 1e-10);
  EXPECT_GT(block.numeric.relative, 0) << "differences are never exact: they were taken";
}

TEST(JacobianAudit, FailsAFactorWithTheJacobianOfTheOtherSide) {
  const JacobianAudit audit = audit_of(turned_point_kind(Perturbation::kRight));
  EXPECT_FALSE(audit.passed());
  const BlockAudit& block = audit.factors.at(0).blocks.at(0);
  EXPECT_FALSE(block.passed);
  EXPECT_GT(block.automatic.relative, 0.5);
  EXPECT_GT(block.numeric.relative, 0.5);
}

TEST(JacobianAudit, FailsAFactorWhoseTwoFormsAreNotOneResidual) {
  FactorKind kind = turned_point_kind(Perturbation::kLeft);
  const auto make = kind.make;
  kind.make = [make](RandomStates& random, Perturbation side) {
    FactorSample sample = make(random, side);
    sample.automatic = make(random, side).automatic;
    return sample;
  };
  EXPECT_FALSE(audit_of(kind).passed());
}

/// Cannot be evaluated, or gives NaN, after the first few states.
class Unreliable final : public ceres::SizedCostFunction<1, 3> {
 public:
  Unreliable(bool evaluates, bool is_finite) : evaluates_(evaluates), is_finite_(is_finite) {}
  bool Evaluate(double const* const* x, double* r, double** jacobians) const override {
    r[0] = x[0][0];
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::RowVector3d> J(jacobians[0]);
      J << 1, 0, (is_finite_ ? 0 : std::numeric_limits<double>::quiet_NaN());
    }
    return evaluates_;
  }

 private:
  bool evaluates_;
  bool is_finite_;
};

TEST(JacobianAudit, FailsWhatCannotBeEvaluatedAndWhatIsNotFinite) {
  const auto kind = [](bool evaluates, bool is_finite) {
    return FactorKind{"unreliable",
                      "",
                      {{"position", 3, false}},
                      {Perturbation::kRight},
                      [=](RandomStates& random, Perturbation) {
                        const bool works = random.uniform(0, 1) < 0.9;
                        auto factor =
                            std::make_shared<Unreliable>(evaluates || works, is_finite || works);
                        return FactorSample{factor, factor, {random.vector(3)}};
                      }};
  };
  EXPECT_TRUE(audit_of(kind(true, true)).passed());
  EXPECT_FALSE(audit_of(kind(false, true)).passed());
  EXPECT_FALSE(audit_of(kind(true, false)).passed());
}

TEST(JacobianAudit, IsTheSameForTheSameSeed) {
  const std::vector<FactorKind> kinds{turned_point_kind(Perturbation::kLeft)};
  AuditOptions options;
  const std::string first = to_json(audit_jacobians(kinds, options));
  EXPECT_EQ(first, to_json(audit_jacobians(kinds, options)));
  options.seed = 2;
  EXPECT_NE(first, to_json(audit_jacobians(kinds, options)));
}

TEST(JacobianAudit, ComesBackFromItsJson) {
  JacobianAudit audit = audit_of(turned_point_kind(Perturbation::kRight));
  const std::string text = to_json(audit);
  const auto read = [](const std::string& json) {
    return audit_from_json(files::JsonDocument::parse(json).root());
  };
  EXPECT_EQ(to_json(read(text)), text);
  EXPECT_FALSE(read(text).passed());
  EXPECT_EQ(read(text).factors.at(0).perturbation, Perturbation::kRight);
  EXPECT_THROW(read("{"), files::InputError);
  EXPECT_THROW(read("{\"states\": 3}"), files::InputError);
}

TEST(Selected, TakesTheKindsAndPerturbationsThatAreUsed) {
  FactorKind kind = turned_point_kind(Perturbation::kLeft);
  kind.perturbations = {Perturbation::kRight, Perturbation::kLeft};
  const std::vector<FactorKind> kinds{kind};
  const auto used = selected(kinds, std::vector<FactorUse>{{"turned point", Perturbation::kLeft}});
  ASSERT_EQ(used.size(), 1U);
  EXPECT_EQ(used[0].perturbations, std::vector{Perturbation::kLeft});
  EXPECT_THROW(selected(kinds, std::vector<FactorUse>{{"no such", Perturbation::kLeft}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace traverse::optimization
