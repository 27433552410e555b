/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpCameraXml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <vector>

#include <libxml/parser.h>
#include <libxml/tree.h>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_core/vpReadFile.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Names of ViSP's three models in the XML, and the elements that each one needs.
struct Model {
  vpCameraParameters::vpCameraParametersProjType type;
  std::string name;
  std::vector<std::string> distortion;
};

const std::vector<Model> &models()
{
  static const std::vector<Model> all = {
      {vpCameraParameters::perspectiveProjWithoutDistortion, "perspectiveProjWithoutDistortion", {}},
      {vpCameraParameters::perspectiveProjWithDistortion, "perspectiveProjWithDistortion", {"kud", "kdu"}},
      {vpCameraParameters::ProjWithKannalaBrandtDistortion,
       "ProjWithKannalaBrandtDistortion",
       {"k1", "k2", "k3", "k4", "k5"}}};
  return all;
}

//! Elements of a camera that say nothing about the picture as delivered.
const std::vector<std::string> ignored = {"subsampling_width", "subsampling_height", "full_width",
                                          "full_height", "additional_information"};

constexpr unsigned int mostPixels = 100000; // along one side of a picture

std::string quoted(const std::string &name)
{
  return "'" + vpShown(name) + "'";
}

/*!
  An element of the file, with the words that errors about it begin with.
*/
struct Element {
  xmlNode *node;
  std::string filename;
  std::string path; // of the element, for messages

  [[noreturn]] void fail(const std::string &problem) const
  {
    throw vpException(vpException::badValue, vpPrintable(filename) + ":" +
                                                 std::to_string(xmlGetLineNo(node)) + ": " +
                                                 (path.empty() ? "" : path + ": ") + problem);
  }

  std::string name() const { return reinterpret_cast<const char *>(node->name); }

  std::string text() const
  {
    const std::unique_ptr<xmlChar, void (*)(void *)> content(xmlNodeGetContent(node),
                                                             [](void *p) { xmlFree(p); });
    const std::string all = content ? reinterpret_cast<const char *>(content.get()) : "";
    const size_t first = all.find_first_not_of(" \t\r\n");
    return first == std::string::npos ? "" : all.substr(first, all.find_last_not_of(" \t\r\n") + 1 - first);
  }

  std::vector<Element> children() const
  {
    std::vector<Element> elements;
    for (xmlNode *child = node->children; child; child = child->next) {
      if (child->type == XML_ELEMENT_NODE) {
        const std::string childName = reinterpret_cast<const char *>(child->name);
        elements.push_back({child, filename, path.empty() ? childName : path + "." + childName});
      }
    }
    return elements;
  }

  std::vector<Element> children(const std::string &wanted) const
  {
    std::vector<Element> elements;
    for (const Element &child : children()) {
      if (child.name() == wanted) {
        elements.push_back(child);
      }
    }
    return elements;
  }

  //! The only child of that name.
  Element child(const std::string &wanted) const
  {
    const std::vector<Element> elements = children(wanted);
    if (elements.empty()) {
      Element{node, filename, path.empty() ? wanted : path + "." + wanted}.fail("missing");
    }
    if (elements.size() > 1) {
      elements[1].fail("twice, expected once");
    }
    return elements[0];
  }

  double number(const std::string &wanted, bool positive) const
  {
    const Element element = child(wanted);
    double value = 0;
    if (!vpParseNumber(element.text(), value) || !std::isfinite(value) || (positive && !(value > 0))) {
      element.fail(vpShown(element.text()) + ", expected a " +
                   (positive ? "number above 0" : "finite number"));
    }
    return value;
  }

  unsigned int pixels(const std::string &wanted) const
  {
    const double value = number(wanted, true);
    if (value != std::floor(value) || value > mostPixels) {
      child(wanted).fail(vpShown(child(wanted).text()) + ", expected a whole number from 1 to " +
                         std::to_string(mostPixels));
    }
    return static_cast<unsigned int>(value);
  }

  //! A pixel of any sensor, of which the picture may be a region.
  double coordinate(const std::string &wanted) const
  {
    const double value = number(wanted, false);
    if (std::abs(value) > mostPixels) {
      child(wanted).fail(vpShown(child(wanted).text()) + ", expected pixels, from -" +
                         std::to_string(mostPixels) + " to " + std::to_string(mostPixels));
    }
    return value;
  }

  void refuseOthers(const std::vector<std::string> &allowed) const
  {
    for (const Element &element : children()) {
      if (std::find(allowed.begin(), allowed.end(), element.name()) == allowed.end()) {
        element.fail("unknown element");
      }
    }
  }
};

//! The parsed file, which owns all elements.
class Document
{
public:
  explicit Document(const std::string &filename) : m_filename(filename), m_document(nullptr, &xmlFreeDoc)
  {
    const std::string bytes = vpReadFile(filename);
    const std::unique_ptr<xmlParserCtxt, void (*)(xmlParserCtxt *)> parser(xmlNewParserCtxt(),
                                                                           &xmlFreeParserCtxt);
    if (!parser || bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
      throw vpException(vpException::ioError,
                        vpPrintable(filename) + ": too large, expected a camera XML of ViSP");
    }
    const int silent = XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_NONET;
    m_document.reset(xmlCtxtReadMemory(parser.get(), bytes.data(), static_cast<int>(bytes.size()), nullptr,
                                       nullptr, silent));
    if (!m_document || !xmlDocGetRootElement(m_document.get())) {
      const xmlError *error = xmlCtxtGetLastError(parser.get());
      std::string message = error && error->message ? error->message : "no elements";
      message.erase(message.find_last_not_of(" \n") + 1);
      throw vpException(vpException::badValue, vpPrintable(filename) + ":" +
                                                   std::to_string(error ? std::max(error->line, 1) : 1) +
                                                   ": not XML: " + vpShown(message));
    }
  }

  std::vector<Element> cameras() const
  {
    return Element{xmlDocGetRootElement(m_document.get()), m_filename, ""}.children("camera");
  }

private:
  std::string m_filename;
  std::unique_ptr<xmlDoc, void (*)(xmlDoc *)> m_document;
};

std::string nameOf(const Element &camera)
{
  const std::vector<Element> names = camera.children("name");
  return names.empty() ? "" : names[0].text();
}

vpCameraParameters parameters(const Element &model)
{
  const Element type = model.child("type");
  const auto found = std::find_if(models().begin(), models().end(),
                                  [&type](const Model &known) { return known.name == type.text(); });
  if (found == models().end()) {
    std::string names;
    for (const Model &known : models()) {
      names += (names.empty() ? "" : ", ") + known.name;
    }
    type.fail(vpShown(type.text()) + ", expected one of " + names);
  }
  std::vector<std::string> allowed = {"type", "px", "py", "u0", "v0"};
  allowed.insert(allowed.end(), found->distortion.begin(), found->distortion.end());
  model.refuseOthers(allowed);

  const double px = model.number("px", true);
  const double py = model.number("py", true);
  const double u0 = model.coordinate("u0");
  const double v0 = model.coordinate("v0");
  std::vector<double> distortion;
  for (const std::string &coefficient : found->distortion) {
    distortion.push_back(model.number(coefficient, false));
  }
  vpCameraParameters camera;
  switch (found->type) {
  case vpCameraParameters::perspectiveProjWithoutDistortion:
    camera.initPersProjWithoutDistortion(px, py, u0, v0);
    break;
  case vpCameraParameters::perspectiveProjWithDistortion:
    camera.initPersProjWithDistortion(px, py, u0, v0, distortion[0], distortion[1]);
    break;
  case vpCameraParameters::ProjWithKannalaBrandtDistortion:
    camera.initProjWithKannalaBrandtDistortion(px, py, u0, v0, distortion);
    break;
  }
  return camera;
}

std::string escaped(const std::string &text)
{
  const std::unique_ptr<xmlChar, void (*)(void *)> special(
      xmlEncodeSpecialChars(nullptr, reinterpret_cast<const xmlChar *>(text.c_str())),
      [](void *p) { xmlFree(p); });
  return reinterpret_cast<const char *>(special.get());
}

//! The file as vpXmlParserCamera writes it, but for its comments.
std::string xmlOf(const vpCameraXml &entry)
{
  const vpCameraParameters &camera = entry.camera;
  const Model &model = *std::find_if(models().begin(), models().end(), [&camera](const Model &known) {
    return known.type == camera.get_projModel();
  });
  std::string xml = "<?xml version=\"1.0\"?>\n<root>\n  <camera>\n";
  const auto add = [&xml](const std::string &indent, const std::string &name, const std::string &text) {
    xml += indent + "<" + name + ">" + text + "</" + name + ">\n";
  };
  add("    ", "name", escaped(entry.name));
  add("    ", "image_width", std::to_string(entry.width));
  add("    ", "image_height", std::to_string(entry.height));
  xml += "    <model>\n";
  add("      ", "type", model.name);
  add("      ", "px", vpNumberText(camera.get_px()));
  add("      ", "py", vpNumberText(camera.get_py()));
  add("      ", "u0", vpNumberText(camera.get_u0()));
  add("      ", "v0", vpNumberText(camera.get_v0()));
  std::vector<double> distortion;
  if (model.type == vpCameraParameters::perspectiveProjWithDistortion) {
    distortion = {camera.get_kud(), camera.get_kdu()};
  } else if (model.type == vpCameraParameters::ProjWithKannalaBrandtDistortion) {
    distortion = camera.getKannalaBrandtDistortionCoefficients();
    distortion.resize(model.distortion.size());
  }
  for (size_t i = 0; i < model.distortion.size(); ++i) {
    add("      ", model.distortion[i], vpNumberText(distortion[i]));
  }
  return xml + "    </model>\n  </camera>\n</root>\n";
}
} // namespace

vpCameraXml vpCameraXml::load(const std::string &filename, const std::string &name)
{
  const Document document(filename);
  const std::vector<Element> cameras = document.cameras();
  std::vector<Element> matches;
  std::string names;
  for (const Element &camera : cameras) {
    names += (names.empty() ? "" : ", ") + quoted(nameOf(camera));
    if (nameOf(camera) == name) {
      matches.push_back(camera);
    }
  }
  if (matches.empty()) {
    throw vpException(vpException::badValue,
                      vpPrintable(filename) + ": no camera " + quoted(name) +
                          ", expected one of those there: " + (names.empty() ? "none" : names));
  }
  if (matches.size() > 1) {
    matches[1].fail(quoted(name) + " a second time, expected one camera of that name");
  }

  Element camera = matches[0];
  camera.path = "camera " + quoted(name);
  std::vector<std::string> allowed = ignored;
  allowed.insert(allowed.end(), {"name", "image_width", "image_height", "model"});
  camera.refuseOthers(allowed);
  const std::vector<Element> all = camera.children("model");
  if (all.size() > 1) {
    all[1].fail("a second projection model, expected one; keep the one to work with");
  }

  vpCameraXml entry;
  entry.name = name;
  entry.width = camera.pixels("image_width");
  entry.height = camera.pixels("image_height");
  entry.camera = parameters(camera.child("model"));
  return entry;
}

void vpCameraXml::save(const std::string &filename) const
{
  if (vpPrintable(name) != name) { // XML has no way to write control characters
    throw vpException(vpException::badValue, vpPrintable(filename) + ": camera.name: " + vpShown(name) +
                                                 ", expected text on one line");
  }
  std::error_code none;
  if (std::filesystem::is_regular_file(filename, none)) {
    if (Document(filename).cameras().size() > 1) {
      throw vpException(vpException::ioError,
                        vpPrintable(filename) +
                            ": holds other cameras, which would be lost; expected camera " + quoted(name) +
                            " alone");
    }
    if (xmlOf(load(filename, name)) == xmlOf(*this)) {
      return;
    }
  }
  vpAtomicFile file(filename);
  file.stream() << xmlOf(*this);
  file.commit();
}

END_VISP_NAMESPACE
