/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/paintedLamps.h"

using namespace paintedLamps;

namespace
{
const double phases[] = {0, 0.13, 0.29, 0.41, 0.57, 0.68, 0.83};
} // namespace

TEST(LedRoiDetector, FindsLampsOfAnySizeAndBrightness)
{
  for (const double diameter : {12, 16, 25, 50, 100, 200, 400})
    for (const double amplitude : {20, 60, 150, 235, 500}) // the last far into saturation
      for (const double background : {0, 20, 60}) {
        const double period = std::clamp(diameter / 4, 4.0, 16.0);
        for (const double phase : {0.0, 0.3, 0.7}) {
          vpLampPicture picture = alone(disc(0, 0, diameter / 2, amplitude, period, 0.5, phase));
          picture.background = background;
          EXPECT_TRUE(findsExactlyTheLamps(picture)) << diameter << " px, amplitude " << amplitude
                                                     << ", background " << background << ", phase " << phase;
          if (diameter > 100)
            break;
        }
      }
}

TEST(LedRoiDetector, ReadoutAlongColumns)
{
  for (const double phase : phases) {
    vpLampPicture picture = alone(disc(0, 0, 28, 150, 12, 0.4, phase));
    picture.columns = true;
    EXPECT_TRUE(findsExactlyTheLamps(picture)) << phase;
  }
}

TEST(LedRoiDetector, UnmodulatedLamp)
{
  for (const double radius : {6.0, 28.0, 100.0}) {
    vpPaintedLamp lamp = disc(0, 0, radius, 150, 1, 1, 0);
    lamp.frequency = 0;
    EXPECT_TRUE(findsExactlyTheLamps(alone(lamp))) << radius;
  }
}

TEST(LedRoiDetector, DarkStripesDoNotBreakALampApart)
{
  for (const double diameter : {40, 80, 200})
    for (const double gap : {0.1, 0.2, 0.3, 0.4}) // share of the diameter
      for (const double lit : {0.1, 0.2})
        for (const double phase : phases)
          EXPECT_TRUE(findsExactlyTheLamps(
              alone(disc(0, 0, diameter / 2, 150, (gap + lit) * diameter, lit / (gap + lit), phase))))
              << diameter << " px, gap " << gap << ", lit " << lit << ", phase " << phase;
}

TEST(LedRoiDetector, HullIsTheDiscWithItsDarkStripes)
{
  for (const double phase : phases) {
    const double radius = 40;
    const vpLampPicture picture = alone(disc(0, 0, radius, 150, 20, 0.5, phase));
    const vpImage<unsigned char> I = picture.render();
    const std::vector<vpLedRoi> rois = vpLedRoiDetector().detect(vpLinePicture(I, false).grey);
    ASSERT_EQ(rois.size(), 1u);
    const std::vector<vpLedChord> hull = rois[0].hull();
    ASSERT_EQ(hull.size(), static_cast<size_t>(rois[0].box.height));
    const Eigen::Vector2d centre = picture.lamps[0].centre;
    for (size_t i = 0; i < hull.size(); ++i) {
      EXPECT_EQ(hull[i].line, rois[0].box.y + static_cast<int>(i));
      const double v = hull[i].line - centre.y(), half = std::sqrt(std::max(0., radius * radius - v * v));
      if (half > 0.5 * radius) { // nearer to its top and bottom the least blur makes a line far longer
        EXPECT_NEAR(hull[i].first, centre.x() - half, 4) << "line " << i << ", phase " << phase;
        EXPECT_NEAR(hull[i].last, centre.x() + half, 4) << "line " << i << ", phase " << phase;
      }
    }
    for (const vpLedChord &chord : rois[0].chords) {
      const vpLedChord &line = hull[static_cast<size_t>(chord.line - rois[0].box.y)];
      EXPECT_LE(line.first, chord.first);
      EXPECT_GE(line.last, chord.last);
    }
  }
}

namespace
{
//! Two discs with \e gap between them, across the lines or along the readout.
vpLampPicture pairPicture(double radius, double gap, double phase, bool along)
{
  const int size = static_cast<int>(4 * radius + gap) + 60;
  const double first = 30 + radius, second = first + 2 * radius + gap + 0.4;
  const vpPaintedLamp other = along ? disc(first + 3, second, radius, 120, radius / 2, 0.6, 0)
                                    : disc(second, first + 3, radius, 120, radius / 2, 0.6, 0);
  return pictureOf({disc(first, first, radius, 150, radius / 3, 0.5, phase), other}, size, size);
}

void expectKeptApart(bool along)
{
  for (const double radius : {10, 28, 60})
    for (const double gap : {6, 10, 20})
      for (const double phase : phases)
        EXPECT_TRUE(findsExactlyTheLamps(pairPicture(radius, gap, phase, along)))
            << "radius " << radius << ", gap " << gap << ", phase " << phase;
}
} // namespace

TEST(LedRoiDetector, KeepsLampsApartAcrossTheLines)
{
  expectKeptApart(false);
}

TEST(LedRoiDetector, KeepsLampsApartAlongTheReadout)
{
  expectKeptApart(true);
}

TEST(LedRoiDetector, KeepsASmallLampBesideALargeOne)
{
  for (const double gap : {6, 10, 20})
    for (const double direction :
         {0.0, 0.25 * M_PI, 0.5 * M_PI}) // from across the lines to along the readout
      for (const double phase : phases) {
        const double u = 60 + (38 + gap) * std::cos(direction), v = 60 + (38 + gap) * std::sin(direction);
        EXPECT_TRUE(findsExactlyTheLamps(
            pictureOf({disc(60, 60, 30, 150, 9, 0.5, 0.2), disc(u, v, 8, 120, 4, 0.5, phase)}, 160, 160)))
            << "gap " << gap << ", direction " << direction << ", phase " << phase;
      }
}

// A reflector's light falls off towards its rim: at its lowest level its ends hardly stand out, though its
// middle does.
TEST(LedRoiDetector, KeepsASmallLampThatFadesOutBesideALargeOne)
{
  const double sigma = 10, u = 165, v = 100; // px
  for (const double amplitude : {60, 120, 180}) {
    vpImage<unsigned char> I = pictureOf({disc(80, v, 50, 150, 9, 0.5, 0.2)}, 300, 200).render();
    for (unsigned int i = 0; i < I.getHeight(); ++i) {
      for (unsigned int j = 0; i / 4 % 2 == 0 && j < I.getWidth(); ++j) {
        const double square = ((i - v) * (i - v) + (j - u) * (j - u)) / (sigma * sigma);
        I[i][j] = cv::saturate_cast<unsigned char>(I[i][j] + amplitude * std::exp(-0.5 * square));
      }
    }
    const std::vector<vpLedRoi> rois = vpLedRoiDetector().detect(vpLinePicture(I, false).grey);
    EXPECT_TRUE(std::any_of(rois.begin(), rois.end(), [&](const vpLedRoi &roi) {
      return roi.box.contains(cv::Point2d(u, v)) && roi.box.width < 6 * sigma && roi.box.height > 2 * sigma;
    })) << amplitude;
  }
}

TEST(LedRoiDetector, DimLampBesideABrightOne)
{
  for (const double gap : {10, 40})
    for (const double phase : phases) {
      EXPECT_TRUE(findsExactlyTheLamps(pictureOf(
          {disc(60, 70, 28, 235, 9, 0.5, 0.2), disc(116 + gap, 80, 28, 20, 7, 0.5, phase)}, 260, 150)))
          << "beside, gap " << gap << ", phase " << phase;
      EXPECT_TRUE(findsExactlyTheLamps(pictureOf(
          {disc(70, 60, 28, 235, 9, 0.5, 0.2), disc(80, 116 + gap, 28, 20, 7, 0.5, phase)}, 150, 260)))
          << "below, gap " << gap << ", phase " << phase;
    }
}

namespace
{
//! A lamp whose middle is \e inside px from a border: 0 left, 1 right, 2 top, 3 bottom.
vpLampPicture cutPicture(int border, double inside, double phase, bool columns)
{
  const int size = 150;
  const double at = border % 2 ? size - 1 - inside : inside;
  vpLampPicture picture = pictureOf({disc(72, 72, 28, 150, 8, 0.5, phase)}, size, size);
  (border >= 2 ? picture.lamps[0].centre.y() : picture.lamps[0].centre.x()) = at;
  picture.columns = columns;
  return picture;
}

//! Light of the lamp on the first line where it is cut there, on the last one otherwise.
double lightAtBorder(const vpLampPicture &picture, int border)
{
  return picture.lamps[0].light(picture.start(border % 2 ? picture.height - 1 : 0), picture.exposure);
}
} // namespace

TEST(LedRoiDetector, FindsLampsCutByABorder)
{
  for (const double inside : {-10, 0, 10, 20})
    for (const double phase : phases)
      for (const bool columns : {false, true})
        for (int border = 0; border < 4; ++border)
          EXPECT_TRUE(findsExactlyTheLamps(cutPicture(border, inside, phase, columns)))
              << "border " << border << ", middle " << inside << ", phase " << phase
              << (columns ? ", columns" : ", rows");
}

TEST(LedRoiDetector, SaysWhichBorderCutsALamp)
{
  for (const double inside : {0, 10, 20})
    for (const double phase : phases)
      for (const bool columns : {false, true})
        for (int border = 0; border < 4; ++border) {
          const vpLampPicture picture = cutPicture(border, inside, phase, columns);
          const bool along = (border >= 2) != columns;
          const double light = along ? lightAtBorder(picture, border) : 1;
          if (light > 0.2)
            for (const vpLedRoi &roi : detect(picture)) {
              EXPECT_EQ(roi.cutAlong, along) << border << " " << inside << " " << phase << " " << columns;
              EXPECT_EQ(roi.cutAcross, !along) << border << " " << inside << " " << phase << " " << columns;
            }
        }
}

// The lamp goes on where the picture ends, whether its last line there is lit or not.
TEST(LedRoiDetector, SaysThatABorderCutsALampInADarkStripe)
{
  int dark = 0, said = 0;
  for (const double inside : {0, 10, 20})
    for (const double phase : phases)
      for (const int border : {2, 3}) {
        const vpLampPicture picture = cutPicture(border, inside, phase, false);
        const std::vector<vpLedRoi> rois = detect(picture);
        if (lightAtBorder(picture, border) < 0.01 && rois.size() == 1) {
          ++dark;
          said += rois[0].cutAlong;
        }
      }
  EXPECT_GT(dark, 5);
  EXPECT_EQ(said, dark);
}

TEST(LedRoiDetector, SaysOfNoWholeLampThatItIsCut)
{
  for (const double phase : phases)
    for (int border = 0; border < 4; ++border)
      for (const vpLedRoi &roi : detect(cutPicture(border, 34, phase, false))) { // 6 px from the border
        EXPECT_FALSE(roi.cutAlong) << border << " " << phase;
        EXPECT_FALSE(roi.cutAcross) << border << " " << phase;
      }
}

TEST(LedRoiDetector, WindowDoesNotSwallowALamp)
{
  for (const double brightness : {60, 150, 240})
    for (const double phase : phases) {
      vpPaintedLamp window = disc(90, 150, 0, brightness, 1, 1, 0);
      window.frequency = 0;
      window.rectangle(120, 220);
      // 20 px off the window: to its right, and below it.
      for (const vpPaintedLamp &lamp :
           {disc(198, 150, 28, 150, 9, 0.5, phase), disc(90, 308, 28, 150, 9, 0.5, phase)}) {
        const vpLampPicture picture = pictureOf({window, lamp}, 320, 380);
        EXPECT_TRUE(holds(detect(picture), picture, lamp))
            << "lamp at " << lamp.centre.transpose() << ", window " << brightness << ", phase " << phase;
      }
    }
}

namespace
{
vpLampOutline fitOnly(const vpLampPicture &picture)
{
  const std::vector<vpLampOutline> outlines = outlinesIn(picture);
  if (outlines.size() != 1) {
    ADD_FAILURE() << "found " << outlines.size() << " regions";
    return {};
  }
  return outlines[0];
}

vpPaintedLamp squareLamp(double side, double angle, double phase)
{
  vpPaintedLamp lamp = disc(0, 0, side, 150, side / 7, 0.5, phase);
  const double middle = 0.5 * (4 * side + 40);
  lamp.centre = {middle, middle};
  lamp.angle = angle;
  lamp.rectangle(side, side);
  return lamp;
}
} // namespace

TEST(LedRoiDetector, SlowSquaresAreQuadrilaterals)
{
  for (const double side : {30, 60, 150})
    for (const double angle : {0.0, M_PI / 6})
      for (const double phase : phases) {
        const int size = static_cast<int>(4 * side + 40);
        const vpLampPicture picture = pictureOf({squareLamp(side, angle, phase)}, size, size);
        EXPECT_TRUE(findsExactlyTheLamps(picture)) << side << " px, angle " << angle << ", phase " << phase;
        EXPECT_EQ(fitOnly(picture).shape, vpLampOutline::Shape::quadrilateral)
            << side << " px, angle " << angle << ", phase " << phase;
      }
}

TEST(LedRoiDetector, LitCornersOfTurnedSquares)
{
  int lit = 0;
  for (const double side : {30, 60, 150})
    for (const double phase : phases) {
      const int size = static_cast<int>(4 * side + 40);
      const vpLampPicture picture = pictureOf({squareLamp(side, M_PI / 6, phase)}, size, size);
      const vpPaintedLamp &lamp = picture.lamps[0];
      const vpLampOutline outline = fitOnly(picture);
      for (const Eigen::Vector2d &corner : lamp.corners) {
        if (lamp.light(picture.start(cvRound(corner.y())), picture.exposure) < 0.5)
          continue;
        ++lit;
        double nearest = 1e9;
        for (const Eigen::Vector2d &found : outline.corners)
          nearest = std::min(nearest, (found - corner).norm());
        EXPECT_LT(nearest, 0.3) << side << " px, phase " << phase << ", corner " << corner.transpose();
      }
    }
  EXPECT_GT(lit, 20);
}

// Nothing shows where a side beyond the picture's border lies.
TEST(LedRoiDetector, SquareOfWhichASideIsNotShownHasNoOutline)
{
  const double side = 86;
  const int size = 384;
  int told = 0;
  for (const double angle : {0.1, 0.35, 0.6})
    for (const double beyond : {-0.2, 0.0, 0.2, 0.4, 0.55}) // of the middle, inside the border: sides
      for (const double phase : phases) {
        vpPaintedLamp lamp = squareLamp(side, angle, phase);
        lamp.centre = {size - beyond * side, 190.3};
        lamp.rectangle(side, side);
        for (const vpLampOutline &outline : outlinesIn(pictureOf({lamp}, size, size))) {
          const Eigen::Vector2d error = outline.centre - lamp.centre;
          const bool region = outline.shape == vpLampOutline::Shape::region;
          told += region ? 0 : 1;
          EXPECT_TRUE(region || error.dot(outline.centreCovariance.inverse() * error) < 30)
              << "angle " << angle << ", " << beyond << " sides inside, phase " << phase << ": off by "
              << error.transpose() << " px";
        }
      }
  EXPECT_GT(told, 30) << "of those that show all sides";
}

TEST(LedRoiDetector, NothingInEmptyAndTinyPictures)
{
  EXPECT_TRUE(vpLedRoiDetector().detect(cv::Mat_<unsigned char>()).empty());
  EXPECT_TRUE(vpLedRoiDetector().detect(vpLinePicture().grey).empty());
  EXPECT_TRUE(vpLedRoiDetector().detect(vpLinePicture(vpImage<unsigned char>(), true).grey).empty());
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(300, 1), cv::Size(1, 300), cv::Size(2, 2), cv::Size(3, 300)})
    for (int kind = 0; kind < 3; ++kind) {
      cv::Mat_<unsigned char> lines(size, static_cast<unsigned char>(kind == 1 ? 255 : 0));
      if (kind == 2)
        lines(cv::Rect(0, 0, (size.width + 1) / 2, (size.height + 1) / 2)) = 255;
      EXPECT_TRUE(vpLedRoiDetector().detect(lines).empty()) << size << " " << kind;
    }
}

TEST(LedRoiDetector, NothingInUniformPictures)
{
  for (const int grey : {0, 1, 128, 254}) {
    const std::vector<vpLedRoi> rois =
        vpLedRoiDetector().detect(cv::Mat_<unsigned char>(200, 300, static_cast<unsigned char>(grey)));
    EXPECT_TRUE(rois.empty()) << grey << ": " << boxes(rois);
  }
  EXPECT_LE(vpLedRoiDetector().detect(cv::Mat_<unsigned char>(200, 300, 255)).size(), 1u);
}

// As narrow as a block, or as two, the picture does not tell how light goes on across it.
TEST(LedRoiDetector, NothingInLightThatGrows)
{
  for (const cv::Size size : {cv::Size(8, 1000), cv::Size(16, 900), cv::Size(1000, 16), cv::Size(640, 480)}) {
    cv::Mat_<unsigned char> lines(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        lines(y, x) = static_cast<unsigned char>(20 + (x + y) / 10);
    const std::vector<vpLedRoi> rois = vpLedRoiDetector().detect(lines);
    EXPECT_TRUE(rois.empty()) << size << ": " << boxes(rois);
  }
}

// At most a few specks.
TEST(LedRoiDetector, NothingInNoise)
{
  for (unsigned int seed = 1; seed <= 5; ++seed)
    for (const double noise : {1, 3, 10, 40})
      for (const double background : {0, 10, 128}) {
        vpLampPicture picture = pictureOf({}, 320, 240);
        picture.noise = noise;
        picture.background = background;
        picture.seed = seed;
        const std::vector<vpLedRoi> rois = detect(picture);
        int largest = 0;
        for (const vpLedRoi &roi : rois)
          largest = std::max({largest, roi.box.width, roi.box.height});
        EXPECT_TRUE(rois.size() <= 3 && largest < 20)
            << "noise " << noise << " on " << background << ", seed " << seed << ": largest " << largest
            << " px, " << boxes(rois);
      }
}

// Black clips half of the noise and more: what is left looks quieter than it is.
TEST(LedRoiDetector, NothingInClippedNoise)
{
  for (const double noise : {3, 5, 10})
    for (const double background : {-1.0 * noise, 0.0, 0.5 * noise}) {
      vpLampPicture picture = pictureOf({}, 640, 480);
      picture.noise = noise;
      picture.background = background;
      const std::vector<vpLedRoi> rois = detect(picture);
      EXPECT_TRUE(rois.empty()) << "noise " << noise << " on " << background << ": " << boxes(rois);
    }
}

TEST(LedRoiDetector, LampInClippedNoise)
{
  for (const double noise : {3, 5})
    for (const double phase : phases) {
      vpLampPicture picture = alone(disc(0, 0, 28, 30 * noise, 9, 0.5, phase));
      picture.noise = noise;
      picture.background = 0;
      EXPECT_TRUE(findsExactlyTheLamps(picture)) << "noise " << noise << ", phase " << phase;
    }
}

// Three standard deviations of a pixel's noise above the background, or 15 grey levels whatever the noise:
// only many pixels together show them.
TEST(LedRoiDetector, LampsThatSinglePixelsHardlyShow)
{
  for (const auto &[noise, amplitude] : {std::make_pair(8., 24.),
                                         {16., 48.},
                                         {40., 120.},
                                         {3.5, 15.},
                                         {4., 15.},
                                         {4.4, 15.},
                                         {5., 15.},
                                         {6., 15.}}) {
    int found = 0, strangers = 0;
    for (const double phase : phases) {
      vpLampPicture picture = alone(disc(0, 0, 40, amplitude, 16, 0.5, phase));
      picture.noise = noise;
      picture.background = 60;
      const cv::Rect lamp = litBy(picture, picture.lamps.front()).most;
      const cv::Rect around(lamp.x - 16, lamp.y - 3, lamp.width + 32, lamp.height + 6);
      for (const vpLedRoi &roi : detect(picture)) {
        const bool whole = (roi.box & around) == roi.box && (roi.box & lamp).area() > 0.7 * lamp.area();
        ++(whole ? found : strangers);
      }
    }
    EXPECT_GE(found, 6) << "noise " << noise; // of seven
    EXPECT_LE(strangers, 1) << "noise " << noise;
  }
}

// Its darkest place is darker by more than the lamp is brighter than what it hangs before.
TEST(LedRoiDetector, DimLampsBeforeACeilingThatIsBrighterOnOneSide)
{
  for (const double bow : {-15, 0, 15}) // grey levels, of the ceiling's middle
    for (const double phase : phases) {
      vpLampPicture picture =
          pictureOf({disc(120, 100, 30, 10, 12, 0.5, phase), disc(420, 200, 40, 10, 15, 0.5, phase),
                     disc(250, 330, 90, 150, 40, 1, 0)}, // the last one steady
                    640, 480);
      picture.background = 40;
      picture.noise = 1;
      vpImage<unsigned char> I = picture.render();
      for (unsigned int y = 0; y < I.getHeight(); ++y)
        for (unsigned int x = 0; x < I.getWidth(); ++x) {
          const double across = x / 320. - 1, along = y / 240. - 1;
          I[y][x] =
              cv::saturate_cast<unsigned char>(I[y][x] + 15 * across + 8 * along - bow * across * across);
        }
      const std::vector<vpLedRoi> rois = vpLedRoiDetector().detect(vpLinePicture(I, false).grey);
      for (const vpPaintedLamp &lamp : picture.lamps)
        EXPECT_TRUE(holds(rois, picture, lamp)) << "bow " << bow << ", phase " << phase;
      EXPECT_EQ(rois.size(), picture.lamps.size()) << boxes(rois);
    }
}

// A cut that separates one of them is best while the others are still together.
TEST(LedRoiDetector, KeepsFourLampsInAColumnApart)
{
  for (const double phase : phases) {
    std::vector<vpPaintedLamp> lamps;
    for (int k = 0; k < 4; ++k)
      lamps.push_back(disc(60 + 5 * (k % 2), 50 + 66 * k, 28, 80 + 40 * k, 6 + 2 * k, 0.5, phase + 0.3 * k));
    EXPECT_TRUE(findsExactlyTheLamps(pictureOf(lamps, 130, 310))) << phase;
  }
}
