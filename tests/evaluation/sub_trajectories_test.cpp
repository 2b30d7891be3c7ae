#include "traverse/evaluation/sub_trajectories.hpp"

#include <array>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"

#include "test_data.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;

/// What rpg_trajectory_evaluation gives.
struct OfRpg {
  const char* sequence;
  bool has_scale;  ///< aligned by "sim3"; else not
  double length_m;
  std::size_t stretches;
  /// rmse and median of: translation in m and in %, rotation in deg and in deg/m, yaw, gravity.
  std::array<double, 12> figures;
};

/// Computed by its compute_relative_error(), compute_statistics() and alignTrajectory(), commit
/// 8c8ceec55c5c5094a6494208cfc5f54afe0bbc4d, on ../shared/data/trajectories.
const std::vector<OfRpg> kOfRpg{
    {"0000",
     false,
     6.93,
     145,
     {0.5881879100638383, 0.4705510050559375, 8.487560029781218, 6.790057793014971,
      0.18873658125954093, 0.163682497677015, 0.027234715910467663, 0.0236194080342013,
      0.10110981394938766, 0.08098782556465581, 0.15936452813523044, 0.134518105940122}},
    {"0000",
     false,
     13.87,
     136,
     {1.1171285661481458, 0.906022323985828, 8.054279496381726, 6.532244585334017,
      0.2996833760287268, 0.2848100815728375, 0.021606588033794297, 0.020534252456585255,
      0.17471806101141552, 0.15690453865945778, 0.24348339971428865, 0.2193922544900593}},
    {"0000",
     false,
     20.81,
     127,
     {1.6592811659183073, 1.4217924767510972, 7.973479893889032, 6.832256015142227,
      0.3671191399929274, 0.35094214504451465, 0.017641477174095505, 0.016864110766194842,
      0.2300455583654713, 0.19546862053909797, 0.28613549252282755, 0.269785446297105}},
    {"0000",
     false,
     27.75,
     117,
     {2.189379884791735, 2.2378515007400717, 7.889657242492737, 8.064329732396654,
      0.4048634379540885, 0.3584169989897146, 0.014589673439786975, 0.012915927891521246,
      0.28911543120118083, 0.287321856880674, 0.28353606739349757, 0.23160398155918904}},
    {"0000",
     false,
     34.69,
     107,
     {2.631548368794006, 2.726361778241882, 7.585899016413969, 7.859215273110067,
      0.43546550104429316, 0.41121992450629874, 0.012553055665733441, 0.011854134462562662,
      0.3455116154715104, 0.3454746903313735, 0.26520655631889095, 0.22161374643195866}},
    {"0001",
     false,
     33.29,
     344,
     {1.1319575414419365, 1.1339916290856977, 3.4002930052326095, 3.4064032114319547,
      0.2411497484247708, 0.176825853754492, 0.007243909535138808, 0.005311680797671733,
      0.11698546023446359, 0.07924942631202839, 0.2108185507612356, 0.15511986481094026}},
    {"0001",
     false,
     66.58,
     317,
     {2.208858901763874, 2.1849778462328153, 3.317601234250335, 3.2817330222781846,
      0.3743490976917806, 0.3475046317049037, 0.005622545774884058, 0.005219354636601137,
      0.18314899683211402, 0.14960815936269134, 0.326434678872959, 0.2787727036474893}},
    {"0001",
     false,
     99.87,
     291,
     {3.2401113383250393, 3.1850825102479705, 3.244328965980815, 3.1892285073074698,
      0.45260923860885427, 0.4407409409658278, 0.004531983965243361, 0.004413146500108419,
      0.20888476316774623, 0.19650681893400054, 0.4015312372050005, 0.3611881399848131}},
    {"0001",
     false,
     133.17,
     265,
     {4.215325452821372, 4.233206645116006, 3.1653716699116714, 3.1787990126274734,
      0.5004092177554786, 0.48239253526094733, 0.0037576722817111844, 0.0036223814317109513,
      0.2082358691851378, 0.1942765635658314, 0.45506702083928796, 0.4220155264044838}},
    {"0001",
     false,
     166.46,
     232,
     {5.034385715812618, 4.851310767521346, 3.0243816627493807, 2.9144003169057706,
      0.49598211865973313, 0.48608160532349465, 0.0029795874003348145, 0.0029201105690465855,
      0.18147913336520638, 0.16753066676446038, 0.4616332138857095, 0.4483876860068564}},
    {"0001",
     true,
     33.29,
     344,
     {0.5348380073952644, 0.4539171340799366, 1.606602605573039, 1.3635239834182538,
      0.2411497484247708, 0.176825853754492, 0.007243909535138808, 0.005311680797671733,
      0.11698546023446359, 0.07924942631202839, 0.2108185507612356, 0.15511986481094026}},
    {"0001",
     true,
     66.58,
     317,
     {0.877551505527145, 0.7809127881260632, 1.318040711215298, 1.1728939443167066,
      0.3743490976917806, 0.3475046317049037, 0.005622545774884058, 0.005219354636601137,
      0.18314899683211402, 0.14960815936269134, 0.326434678872959, 0.2787727036474893}},
    {"0001",
     true,
     99.87,
     291,
     {1.2568554981521372, 1.0772112823791369, 1.2584915371504324, 1.0786134799030107,
      0.45260923860885427, 0.4407409409658278, 0.004531983965243361, 0.004413146500108419,
      0.20888476316774623, 0.19650681893400054, 0.4015312372050005, 0.3611881399848131}},
    {"0001",
     true,
     133.17,
     265,
     {1.577285994631011, 1.2671157811471419, 1.1844154048441928, 0.951502426332614,
      0.5004092177554786, 0.48239253526094733, 0.0037576722817111844, 0.0036223814317109513,
      0.2082358691851378, 0.1942765635658314, 0.45506702083928796, 0.4220155264044838}},
    {"0001",
     true,
     166.46,
     232,
     {1.8883222750843252, 1.3439559968150863, 1.1344000210767302, 0.8073747427700866,
      0.49598211865973313, 0.48608160532349465, 0.0029795874003348145, 0.0029201105690465855,
      0.18147913336520638, 0.16753066676446038, 0.4616332138857095, 0.4483876860068564}},
    {"0002",
     false,
     11.38,
     103,
     {0.49163028942115705, 0.4560059273793273, 4.320125566091012, 4.007081962911488,
      0.08156947018742455, 0.055882745721372334, 0.007167791756364197, 0.004910610344584563,
      0.03990776405178307, 0.024640130600882288, 0.07113830439964018, 0.04675943598766764}},
    {"0002",
     false,
     22.77,
     87,
     {0.9337480550441549, 0.906541621416812, 4.100781972086757, 3.9812982934423014,
      0.11403343703483244, 0.08376717488121455, 0.00500805608409453, 0.003678839476557512,
      0.04891781002707178, 0.028809548084500456, 0.1030065978030654, 0.07380118653053455}},
    {"0002",
     false,
     34.16,
     75,
     {1.3703032713973125, 1.3465470088035076, 4.011426438516723, 3.941882344272564,
      0.1370177588138063, 0.11013636668837039, 0.004011058513284728, 0.0032241325142965574,
      0.054605253470629486, 0.041074880934042136, 0.12566665463542415, 0.09903186807156936}},
    {"0002",
     false,
     45.55,
     66,
     {1.8113958253001667, 1.7962949334783227, 3.9767197042813756, 3.9435673621917076,
      0.16504354158073387, 0.14048608887382558, 0.0036233488821236855, 0.0030842170993156002,
      0.04936422713957555, 0.03775647467675042, 0.15748573473757094, 0.13091136982215928}},
    {"0002",
     false,
     56.94,
     58,
     {2.253209279363453, 2.2566006852598735, 3.9571641716955637, 3.9631202761852364,
      0.20468077237855536, 0.17997401706136532, 0.003594674611495528, 0.0031607660179375713,
      0.05406448884765215, 0.03092061621342527, 0.19740807972624708, 0.16862980756110507}},
};

std::array<double, 12> figures_of(const SubTrajectoryErrors& errors) {
  std::array<double, 12> figures{};
  std::size_t k = 0;
  for (const Statistics* s :
       {&errors.translation_m, &errors.translation_percent, &errors.rotation_deg,
        &errors.rotation_deg_per_m, &errors.yaw_deg, &errors.gravity_deg}) {
    figures[k++] = s->rmse;
    figures[k++] = s->median;
  }
  return figures;
}

TEST(SubTrajectories, AreThoseOfRpgTrajectoryEvaluation) {
  const auto folder = testing::test_data() / "trajectories";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no trajectories in " << folder;
  for (std::size_t row = 0; row < kOfRpg.size(); row += 5) {
    SCOPED_TRACE(kOfRpg[row].sequence);
    const std::string name = kOfRpg[row].sequence;
    const auto kitti = dataset::TrajectoryFormat::kKitti;
    const auto estimate = dataset::read_trajectory(folder / (name + "_orbslam3_cam.txt"), kitti);
    const auto reference = dataset::read_trajectory(folder / (name + "_oxts_gt_cam0.txt"), kitti);
    EvaluationOptions options;
    options.alignment.mode = kOfRpg[row].has_scale ? AlignmentMode::kSim3 : AlignmentMode::kSe3;
    const Evaluation evaluation = evaluate(estimate, reference, options);
    const auto& found = evaluation.comparison->sub_trajectories;
    ASSERT_EQ(found.size(), 5U);
    for (std::size_t k = 0; k < 5; ++k) {
      const OfRpg& known = kOfRpg[row + k];
      EXPECT_EQ(found[k].length_m, known.length_m);
      EXPECT_EQ(found[k].translation_m.count, known.stretches);
      const auto figures = figures_of(found[k]);
      for (std::size_t i = 0; i < figures.size(); ++i) {
        EXPECT_NEAR(figures[i], known.figures[i], 1e-9) << known.length_m << " m, figure " << i;
      }
    }
    const std::string text = to_json(evaluation);
    EXPECT_EQ(to_json(from_json(text)), text);
  }
}

std::vector<Pose3> along_x(const std::vector<double>& metres) {
  std::vector<Pose3> poses;
  for (const double x : metres) {
    Pose3 pose;
    pose.translation.x() = x;
    poses.push_back(pose);
  }
  return poses;
}

TEST(SubTrajectories, EndAtTheNearestPoseAndTheFirstOfEqualOnes) {
  // From 0: 10 m lie between 9 and 11, as near, of which the first of the two at 9 counts. From the
  // others 10 m lead beyond the end, but where a pose is within 2 m.
  const auto reference = along_x({0, 9, 9, 11, 18.5});
  const auto estimate = along_x({0, 9.5, 9, 11, 18.5});
  const auto found = sub_trajectory_errors(estimate, reference, 1, {10});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].translation_m.count, 3U);  // 0 to 9, and twice 9 to 18.5
  EXPECT_NEAR(found[0].translation_m.max, 0.5, 1e-12);
  EXPECT_NEAR(found[0].translation_percent.max, 5, 1e-12);
  EXPECT_NEAR(found[0].translation_m.min, 0, 1e-12);
}

TEST(SubTrajectories, LeaveOutStartsBeforeAJumpOfTheReference) {
  const auto reference = along_x({0, 100, 110, 120, 130});
  const auto estimate = along_x({0, 100, 111, 120, 130});
  const auto found = sub_trajectory_errors(estimate, reference, 1, {10, 1000});
  ASSERT_EQ(found.size(), 1U);  // nothing is 1000 m long
  EXPECT_EQ(found[0].translation_m.count, 3U);
  EXPECT_NEAR(found[0].translation_m.mean, 2.0 / 3, 1e-12);
  EXPECT_THROW(sub_trajectory_errors(estimate, reference, 1, {0}), std::invalid_argument);
}

TEST(SubTrajectories, LengthsWithTooFewAreTold) {
  const auto poses = along_x({0, 1, 2, 3, 4});
  const auto trajectory = geometry::Trajectory::unstamped(poses);
  EvaluationOptions options;
  options.sub_trajectory_lengths_m = {2, 4};
  const Comparison comparison = *evaluate(trajectory, trajectory, options).comparison;
  EXPECT_EQ(comparison.sub_trajectories.size(), 1U);
  EXPECT_THAT(comparison.undefined, ::testing::Contains(::testing::Field(
                                        &Undefined::metric, "relative errors over 4 m")));
}

}  // namespace
}  // namespace traverse::evaluation
