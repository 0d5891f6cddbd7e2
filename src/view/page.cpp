// The page: a template that Vite made of viewer/ (committed as viewer/dist/page.html, part of the program),
// and the data as JSON in it.
#include "insym/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "view/page_template.hpp"
#include "view/shaded_mesh.hpp"
#include "view/shown_part.hpp"

namespace insym {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kPlaceOfData = "<!--insym:data-->";

/// JSON that no reader of HTML can take for markup. What is replaced occurs only in strings of JSON, where \u
/// and four digits mean the same.
std::string safe_in_html(std::string_view json) {
    std::string safe;
    safe.reserve(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) {
        const std::string_view rest = json.substr(i, 3);
        if (json[i] == '<')
            safe += "\\u003c";
        else if (json[i] == '>')
            safe += "\\u003e";
        else if (json[i] == '&')
            safe += "\\u0026";
        else if (rest == "\xe2\x80\xa8" || rest == "\xe2\x80\xa9") {
            safe += rest == "\xe2\x80\xa8" ? "\\u2028" : "\\u2029";
            i += 2;
        } else
            safe += json[i];
    }
    return safe;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18U - 6U * k) & 63U] : '=';
    }
    return text;
}

/// Numbers as the page reads them: little-endian, in base 64.
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return base64(bytes);
}

template <class Number, class From>
std::vector<Number> flat(const std::vector<std::array<From, 3>>& items) {
    std::vector<Number> numbers;
    numbers.reserve(3 * items.size());
    for (const auto& item : items)
        for (const From value : item) numbers.push_back(static_cast<Number>(value));
    return numbers;
}

std::vector<std::int8_t> in_bytes(const std::vector<std::array<float, 3>>& normals) {
    constexpr float kLongest = 127;
    std::vector<std::int8_t> bytes;
    bytes.reserve(3 * normals.size());
    for (const auto& normal : normals)
        for (const float x : normal) bytes.push_back(static_cast<std::int8_t>(std::lround(kLongest * x)));
    return bytes;
}

/// The model relative to `origin`; polylines one after another, `line_starts` where each begins.
Json model_data(const Tessellation& model, const Point& origin) {
    const ShadedMesh mesh = shade(model, origin);
    std::vector<float> line_points;
    std::vector<std::uint32_t> line_starts;
    std::vector<std::int32_t> line_edges;
    for (const Tessellation::Line& line : model.lines) {
        line_starts.push_back(static_cast<std::uint32_t>(line_points.size() / 3));
        line_edges.push_back(static_cast<std::int32_t>(line.edge));
        for (const int v : line.vertices)
            for (std::size_t k = 0; k < 3; ++k)
                line_points.push_back(
                    static_cast<float>(model.vertices[static_cast<std::size_t>(v)][k] - origin[k]));
    }
    return {{"origin", origin},
            {"positions", packed(flat<float>(mesh.positions))},
            {"normals", packed(in_bytes(mesh.normals))},
            {"triangles", packed(flat<std::uint32_t>(mesh.triangles))},
            {"faces", packed(std::vector<std::int32_t>(mesh.faces.begin(), mesh.faces.end()))},
            {"line_points", packed(line_points)},
            {"line_starts", packed(line_starts)},
            {"line_edges", packed(line_edges)}};
}

void write_data(std::ostream& out, std::string_view id, std::string_view json) {
    out << R"(<script type="application/json" id=")" << id << "\">" << safe_in_html(json) << "</script>\n";
}

}  // namespace

void write_page(std::ostream& out, const DetectResult& result, const ReportContext& context,
                const Tessellation& model, int limit) {
    const std::string_view page = page_template();
    const std::size_t place = page.find(kPlaceOfData);
    out << page.substr(0, place);
    std::ostringstream report;
    write_json(report, shown_part(result, limit), context);
    write_data(out, "insym-report", report.str());
    write_data(out, "insym-model", model_data(model, middle_of(result, model)).dump());
    out << page.substr(place + kPlaceOfData.size());
}

}  // namespace insym
