/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <sstream>

#include <visp3/vlp_calibration/vpBoard.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
const double point = 25.4 / 72; // mm, PDF's unit

std::string number(double value)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed;
  text.precision(5);
  text << value;
  return text.str();
}

//! Drawing operators of a page whose unit is the millimetre.
class Page
{
public:
  Page() { m_operators = number(1 / point) + " 0 0 " + number(1 / point) + " 0 0 cm\n"; }

  void rectangle(double x, double y, double width, double height)
  {
    m_operators += number(x) + " " + number(y) + " " + number(width) + " " + number(height) + " re\n";
  }

  void disc(double x, double y, double radius)
  {
    const double k = 0.5522847498 * radius; // of Bezier curves that make a circle to 0.03 %
    m_operators += number(x + radius) + " " + number(y) + " m\n";
    const double corners[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (int i = 0; i < 4; ++i) {
      const double a = corners[i][0], b = corners[i][1];
      const bool across = i % 2 == 0; // from the side of x to that of y
      const double x1 = x + (across ? a * radius : a * k), y1 = y + (across ? b * k : b * radius);
      const double x2 = x + (across ? a * k : a * radius), y2 = y + (across ? b * radius : b * k);
      const double x3 = x + (across ? 0 : a * radius), y3 = y + (across ? b * radius : 0);
      m_operators += number(x1) + " " + number(y1) + " " + number(x2) + " " + number(y2) + " " + number(x3) +
                     " " + number(y3) + " c\n";
    }
  }

  void fill() { m_operators += "f\n"; }

  void text(double x, double y, double size, const std::string &words)
  {
    m_operators +=
        "BT /F1 " + number(size) + " Tf " + number(x) + " " + number(y) + " Td (" + words + ") Tj ET\n";
  }

  //! The file: catalogue, pages, page, content, font, and where each of them begins.
  std::string file(double width, double height) const
  {
    const std::vector<std::string> objects = {
        "<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + number(width / point) + " " +
            number(height / point) + "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
        "<< /Length " + std::to_string(m_operators.size()) + " >>\nstream\n" + m_operators + "endstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"};
    std::string pdf = "%PDF-1.4\n", table;
    for (size_t i = 0; i < objects.size(); ++i) {
      std::string offset = std::to_string(pdf.size());
      table += std::string(10 - offset.size(), '0') + offset + " 00000 n \n";
      pdf += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
    }
    const std::string count = std::to_string(objects.size() + 1);
    return pdf + "xref\n0 " + count + "\n0000000000 65535 f \n" + table + "trailer\n<< /Size " + count +
           " /Root 1 0 R >>\nstartxref\n" + std::to_string(pdf.size()) + "\n%%EOF\n";
  }

private:
  std::string m_operators;
};

//! Black runs of the pattern's rows, each as one rectangle.
void drawPattern(Page &page, const cv::Mat_<unsigned char> &pattern, double pixel, double left, double bottom)
{
  for (int y = 0; y < pattern.rows; ++y) {
    for (int x = 0; x < pattern.cols; ++x) {
      const int first = x;
      while (x < pattern.cols && pattern(y, x) < 128) {
        ++x;
      }
      if (x > first) {
        page.rectangle(left + first * pixel, bottom + (pattern.rows - 1 - y) * pixel, (x - first) * pixel,
                       pixel);
      }
    }
  }
}
} // namespace

std::string vpBoard::pdf() const
{
  check();
  const double square = 1000 * spacing, foot = 20; // mm
  const double width = (columns + 3) * square, height = (rows + 3) * square + foot;
  const double papers[][2] = {{297, 210}, {420, 297}};
  double pageWidth = std::max(width, 140.0), pageHeight = height;
  for (const auto &paper : papers) {
    if (width <= paper[0] && height <= paper[1]) {
      pageWidth = paper[0];
      pageHeight = paper[1];
      break;
    }
  }
  const double left = 0.5 * (pageWidth - width), bottom = 0.5 * (pageHeight - height) + foot;
  Page page;
  if (kind == Kind::circles) {
    static const double share = 0.3; // radius, of the spacing
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        page.disc(left + (column + 2) * square, bottom + (row + 2) * square, share * square);
      }
    }
  } else {
    const int perSquare = kind == Kind::charuco ? 20 : 1;
    drawPattern(page, pattern(perSquare), square / perSquare, left, bottom);
  }
  page.rectangle(0.5 * pageWidth - 50, bottom - 12, 100, 0.5);
  page.fill();
  const char *const names[] = {"chessboard", "charuco", "circles"};
  page.text(0.5 * pageWidth - 50, bottom - 17, 3.5,
            std::string(names[static_cast<int>(kind)]) + " " + size() + ", " + vpNumberText(square) +
                " mm; the line is 100 mm long: print at 100 %, then measure it");
  return page.file(pageWidth, pageHeight);
}

END_VISP_NAMESPACE
