#include "look.hpp"

#include <cmath>
#include <nanovg.h>

#include "traverse/render/palette.hpp"
#include "traverse/render/theme.hpp"

namespace traverse::app {

nanogui::Color to_nanogui(render::Colour colour, float opacity) {
  return {static_cast<float>(colour.red) / 255, static_cast<float>(colour.green) / 255,
          static_cast<float>(colour.blue) / 255, opacity};
}

NVGcolor to_nanovg(render::Colour colour, float opacity) {
  return nvgRGBAf(static_cast<float>(colour.red) / 255, static_cast<float>(colour.green) / 255,
                  static_cast<float>(colour.blue) / 255, opacity);
}

mrpt::img::TColor to_mrpt(render::Colour colour) { return {colour.red, colour.green, colour.blue}; }
mrpt::math::TPoint3Df to_mrpt(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }
mrpt::poses::CPose3D to_mrpt(const geometry::Pose3& pose) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(pose.matrix()));
}

nanogui::ref<nanogui::Theme> window_theme(NVGcontext* context) {
  const render::Theme dark = render::dark_theme();
  const auto shade = [&](double towards_axis, float opacity = 1) {
    return to_nanogui(render::mix(dark.background, dark.axis, towards_axis), opacity);
  };
  nanogui::ref<nanogui::Theme> theme = new nanogui::Theme(context);
  theme->mStandardFontSize = 15;
  theme->mButtonFontSize = 15;
  theme->mTextBoxFontSize = 15;
  theme->mWindowCornerRadius = 0;
  theme->mWindowDropShadowSize = 0;
  theme->mButtonCornerRadius = 3;
  theme->mTextColor = to_nanogui(dark.text);
  theme->mDisabledTextColor = to_nanogui(dark.muted, 0.6F);
  theme->mTextColorShadow = shade(0, 0);
  theme->mIconColor = to_nanogui(dark.text);
  theme->mBorderDark = shade(0.35);
  theme->mBorderLight = shade(0.2);
  theme->mBorderMedium = shade(0.35);
  theme->mWindowFillUnfocused = shade(0.08);
  theme->mWindowFillFocused = shade(0.08);
  theme->mWindowPopup = shade(0.14);
  theme->mButtonGradientTopUnfocused = shade(0.3);
  theme->mButtonGradientBotUnfocused = shade(0.3);
  theme->mButtonGradientTopFocused = shade(0.5);
  theme->mButtonGradientBotFocused = shade(0.5);
  theme->mButtonGradientTopPushed = to_nanogui(render::palette::kBlue);
  theme->mButtonGradientBotPushed = to_nanogui(render::palette::kBlue);
  return theme;
}

}  // namespace traverse::app
