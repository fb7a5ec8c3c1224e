#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/json_value.h"
#include "report/drawing.h"

namespace raygrain {

namespace {

std::string hex(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

const char* name(Anchor anchor) {
  return anchor == Anchor::kStart ? "start" : anchor == Anchor::kMiddle ? "middle" : "end";
}

/// What is shown when a reader points at the shape.
std::string titled(const std::string& element, const std::string& attributes, const std::string& title) {
  if (title.empty()) return fmt::format("<{} {}/>\n", element, attributes);
  return fmt::format("<{0} {1}><title>{2}</title></{0}>\n", element, attributes, escaped(title));
}

std::string element(const Shape& s) {
  switch (s.kind) {
    case Shape::Kind::kBox:
      return titled("rect",
                    fmt::format("x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"", s.x0, s.y0,
                                s.x1 - s.x0, s.y1 - s.y0, hex(s.colour)),
                    s.text);
    case Shape::Kind::kLine:
      return titled(
          "line",
          fmt::format("x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{:.1f}\"",
                      s.x0, s.y0, s.x1, s.y1, hex(s.colour), s.width),
          s.text);
    case Shape::Kind::kDot:
      return titled(
          "circle",
          fmt::format("cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"", s.x0, s.y0, s.width / 2, hex(s.colour)),
          s.text);
    case Shape::Kind::kText:
      return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", s.x0, s.y0,
                         name(s.anchor), hex(s.colour), escaped(s.text));
  }
  return {};
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  // Through JSON, because that mends broken UTF-8.
  for (const char c : nlohmann::json::parse(json_text(text)).get<std::string>()) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t' ? ' ' : c;
    }
  }
  return result;
}

std::string svg_text(const Drawing& drawing) {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"system-ui, DejaVu Sans, sans-serif\" font-size=\"15\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
      drawing.width, drawing.height);
  for (const Shape& shape : drawing.shapes) text += element(shape);
  return text + "</svg>\n";
}

}  // namespace raygrain
