#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "traverse/evaluation/evaluate.hpp"

#include "evaluation/golden_trajectories.hpp"

namespace traverse::evaluation {
namespace {

constexpr double kPrinted = 1e-9;  // the known values have twelve decimals

struct Known {
  double rmse, mean, median, std, min, max;
};

void expect_known(const Statistics& found, const Known& known) {
  EXPECT_NEAR(found.rmse, known.rmse, kPrinted);
  EXPECT_NEAR(found.mean, known.mean, kPrinted);
  EXPECT_NEAR(found.median, known.median, kPrinted);
  EXPECT_NEAR(found.std, known.std, kPrinted);
  EXPECT_NEAR(found.min, known.min, kPrinted);
  EXPECT_NEAR(found.max, known.max, kPrinted);
  EXPECT_NEAR(found.sse, known.rmse * known.rmse * static_cast<double>(found.count),
              kPrinted * static_cast<double>(found.count) * (1 + known.rmse));
}

class Golden : public ::testing::Test {
 protected:
  static MatchedPoses matched() {
    static const auto estimate = testing::golden_estimate();
    static const auto reference = testing::golden_reference();
    static const auto association = associate(estimate, reference, {});
    return matched_poses(estimate, reference, association.matches);
  }
  static MatchedPoses matched_and_aligned(const AlignmentOptions& options) {
    MatchedPoses poses = matched();
    poses.estimate = aligned(poses.estimate, align(poses.estimate, poses.reference, options));
    return poses;
  }
};

TEST_F(Golden, AssociationFinds514Pairs) { EXPECT_EQ(matched().size(), 514U); }

TEST_F(Golden, Ape) {
  struct Case {
    Relation relation;
    AlignmentOptions alignment;
    Known known;
  };
  const AlignmentOptions none{AlignmentMode::kNone, {}};
  const AlignmentOptions se3{AlignmentMode::kSe3, {}};
  const AlignmentOptions sim3{AlignmentMode::kSim3, {}};
  const AlignmentOptions first_50{AlignmentMode::kSe3, 50};
  const AlignmentOptions origin{AlignmentMode::kOrigin, {}};
  const Case cases[] = {
      {Relation::kFull,
       none,
       {42.440864273016, 38.866337395553, 42.456100232102, 17.048013892989, 4.697608060717,
        59.392868050220}},
      {Relation::kTranslation,
       none,
       {42.438088171709, 38.861840353231, 42.453274817386, 17.051354551172, 4.676223695694,
        59.390882094055}},
      {Relation::kRotation,
       none,
       {0.485419994190, 0.484871497322, 0.485354083809, 0.023069500289, 0.443507012101,
        0.528893674055}},
      {Relation::kAngleRad,
       none,
       {0.344967359013, 0.344569739088, 0.344904182892, 0.016558191006, 0.314906370995,
        0.376198787744}},
      {Relation::kAngleDeg,
       none,
       {19.765173741226, 19.742391797659, 19.761554016139, 0.948714461024, 18.042805999795,
        21.554602795676}},
      {Relation::kFull,
       se3,
       {2.009219022483, 2.009188614508, 2.009237286764, 0.011054032627, 1.989133652780,
        2.029402352336}},
      {Relation::kTranslation,
       se3,
       {2.008707081862, 2.008676813676, 2.008570650558, 0.011027190225, 1.989078352475,
        2.027926002410}},
      {Relation::kRotation,
       se3,
       {0.045353495815, 0.038417652303, 0.038125723053, 0.024104430592, 0.000283371815,
        0.082675934526}},
      {Relation::kAngleRad,
       se3,
       {0.032072375045, 0.027167215772, 0.026959773776, 0.017046396341, 0.000200374133,
        0.058469042087}},
      {Relation::kAngleDeg,
       se3,
       {1.837611729022, 1.556566804840, 1.544681253979, 0.976686566259, 0.011480592125,
        3.350029343742}},
      {Relation::kFull,
       sim3,
       {0.149576037190, 0.131235971871, 0.104196550762, 0.071764270975, 0.027253329583,
        0.331790188372}},
      {Relation::kTranslation,
       sim3,
       {0.142534386444, 0.121956146204, 0.094894278766, 0.073774993880, 0.020430743379,
        0.321324476114}},
      {Relation::kRotation,
       sim3,
       {0.045353495815, 0.038417652303, 0.038125723053, 0.024104430592, 0.000283371815,
        0.082675934526}},
      {Relation::kAngleRad,
       sim3,
       {0.032072375045, 0.027167215772, 0.026959773776, 0.017046396341, 0.000200374133,
        0.058469042087}},
      {Relation::kAngleDeg,
       sim3,
       {1.837611729022, 1.556566804840, 1.544681253979, 0.976686566259, 0.011480592125,
        3.350029343742}},
      {Relation::kFull,
       first_50,
       {2.826388489338, 2.544724453228, 2.827385077893, 1.229979410319, 0.024513771668,
        4.012033048038}},
      {Relation::kTranslation,
       first_50,
       {2.825970052095, 2.544130478037, 2.827275256095, 1.230246660659, 0.023878715493,
        4.011780541168}},
      {Relation::kRotation,
       first_50,
       {0.048632883181, 0.042066750497, 0.042115984566, 0.024403807675, 0.001572963984,
        0.086628616008}},
      {Relation::kAngleRad,
       first_50,
       {0.034391712652, 0.029747892749, 0.029781598890, 0.017258411750, 0.001112253557,
        0.061265262834}},
      {Relation::kAngleDeg,
       first_50,
       {1.970499985204, 1.704428703945, 1.706359923558, 0.988834154376, 0.063727434572,
        3.510240991131}},
      {Relation::kTranslation,
       origin,
       {2.834264870008, 2.552225433159, 2.837699336046, 1.232559406965, 0.000000000000,
        4.021872891489}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(name_of(c.relation)) + ", " + std::string(name_of(c.alignment.mode)));
    const MatchedPoses poses = matched_and_aligned(c.alignment);
    expect_known(ape(poses.estimate, poses.reference, c.relation).statistics, c.known);
  }
}

TEST_F(Golden, Rpe) {
  struct Case {
    Relation relation;
    Delta delta;
    bool all_pairs;
    std::size_t pairs;
    Known known;
  };
  const Delta frames_10{10, DeltaUnit::kFrames};
  const Delta metres_20{20, DeltaUnit::kMetres};
  const Case cases[] = {
      {Relation::kTranslation,
       frames_10,
       false,
       51,
       {0.434468696744, 0.413668508195, 0.394825420261, 0.132820983953, 0.230429451331,
        0.689844697167}},
      {Relation::kTranslation,
       frames_10,
       true,
       504,
       {0.435186732032, 0.414698424932, 0.398755591472, 0.131957220702, 0.220353416743,
        0.697699863259}},
      {Relation::kTranslation,
       metres_20,
       false,
       27,
       {0.773689106584, 0.738707382969, 0.706730111456, 0.230013556111, 0.417405222989,
        1.144299299989}},
      {Relation::kTranslation,
       metres_20,
       true,
       499,
       {0.731867043314, 0.698159316967, 0.667986136748, 0.219551673234, 0.404646593697,
        1.178573333357}},
      {Relation::kAngleDeg,
       frames_10,
       false,
       51,
       {0.178514961350, 0.166524786287, 0.162531939410, 0.064320191061, 0.064481888525,
        0.282113715175}},
      {Relation::kAngleDeg,
       frames_10,
       true,
       504,
       {0.179038511748, 0.165989766636, 0.153897699336, 0.067098331284, 0.031961948782,
        0.333979511275}},
      {Relation::kAngleDeg,
       metres_20,
       false,
       27,
       {0.245802462830, 0.218273915101, 0.206134719957, 0.113028088189, 0.040256967305,
        0.472745963599}},
      {Relation::kAngleDeg,
       metres_20,
       true,
       499,
       {0.214090391468, 0.195445788781, 0.202002331274, 0.087382145584, 0.009488616855,
        0.423584821028}},
      {Relation::kPointDistanceRatio,
       frames_10,
       false,
       51,
       {2.122413669370, 2.111646450681, 2.117624752710, 0.213515927406, 1.817856147961,
        2.458374202662}},
      {Relation::kPointDistanceRatio,
       frames_10,
       true,
       504,
       {2.122480073064, 2.110543830990, 2.050927380922, 0.224780777704, 1.817310236076,
        2.488126924446}},
      {Relation::kPointDistanceRatio,
       metres_20,
       false,
       27,
       {2.101718017473, 2.101683634595, 2.100501628179, 0.012021857013, 2.075375938252,
        2.147771003550}},
      {Relation::kPointDistanceRatio,
       metres_20,
       true,
       499,
       {2.104878029530, 2.103398250258, 2.083208751978, 0.078913370270, 1.876340746012,
        2.274020714865}},
  };
  const MatchedPoses poses = matched_and_aligned({AlignmentMode::kSe3, {}});
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(name_of(c.relation)) + ", " + to_text(c.delta));
    const Rpe found = rpe(poses.estimate, poses.reference,
                          {c.delta, c.all_pairs, PairsFrom::kEstimate}, c.relation);
    EXPECT_EQ(found.values.size(), c.pairs);
    expect_known(found.statistics, c.known);
  }
}

TEST_F(Golden, KittiDrift) {
  const MatchedPoses poses = matched();
  const auto drift = kitti_drift(poses.estimate, poses.reference, {});
  ASSERT_TRUE(drift);
  EXPECT_EQ(drift->segments.size(), 131U);
  EXPECT_NEAR(drift->translation_percent, 2.111629877802, kPrinted);
  EXPECT_NEAR(drift->rotation_deg_per_m, 0.005867857732, kPrinted);
}

TEST_F(Golden, KittiDriftFromEveryPose) {
  const MatchedPoses poses = matched();
  KittiDriftOptions options;
  options.step = 1;
  const auto drift = kitti_drift(poses.estimate, poses.reference, options);
  ASSERT_TRUE(drift);
  EXPECT_EQ(drift->segments.size(), 1286U);
  EXPECT_NEAR(drift->translation_percent, 2.136420123751, kPrinted);
}

}  // namespace
}  // namespace traverse::evaluation
