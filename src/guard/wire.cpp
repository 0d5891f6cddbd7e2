#include "guard/wire.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace insym {
namespace {

constexpr std::uint64_t kEnd = 0x696e73796d2e3031;  ///< a whole message ends with it

class Writer {
public:
    template <class Number>
    std::enable_if_t<std::is_arithmetic_v<Number> || std::is_enum_v<Number>> pass(const Number& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void pass(const std::string& text) {
        pass(text.size());
        bytes_ += text;
    }
    template <class Item>
    void pass(const std::vector<Item>& items) {
        pass(items.size());
        for (const Item& item : items) pass(item);
    }
    template <class Item>
    void pass(const std::optional<Item>& item) {
        pass(item.has_value());
        if (item) pass(*item);
    }
    template <class Struct>
    std::enable_if_t<!std::is_arithmetic_v<Struct> && !std::is_enum_v<Struct>> pass(const Struct& value) {
        visit_members(*this, value);
    }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Once something is missing, everything after it is, too.
class Reader {
public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    template <class Number>
    std::enable_if_t<std::is_arithmetic_v<Number> || std::is_enum_v<Number>> pass(Number& value) {
        if (!has(sizeof value)) return;
        std::memcpy(&value, bytes_.data(), sizeof value);
        bytes_.remove_prefix(sizeof value);
    }
    void pass(std::string& text) {
        const std::size_t size = count();
        text = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
    }
    template <class Item>
    void pass(std::vector<Item>& items) {
        items.resize(count());  // an item is at least a byte
        for (Item& item : items) pass(item);
    }
    template <class Item>
    void pass(std::optional<Item>& item) {
        char present = 0;
        pass(present);
        if (present != 0) pass(item.emplace());
    }
    template <class Struct>
    std::enable_if_t<!std::is_arithmetic_v<Struct> && !std::is_enum_v<Struct>> pass(Struct& value) {
        visit_members(*this, value);
    }
    bool good() const { return good_; }

private:
    bool has(std::size_t size) { return good_ = good_ && size <= bytes_.size(); }
    std::size_t count() {
        std::size_t size = 0;
        pass(size);
        return has(size) ? size : 0;
    }

    std::string_view bytes_;
    bool good_ = true;
};

// One list of members for both directions; `Value` is const for the writer.

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Point>
void visit_members(Pass& pass, Value& point) {
    for (auto& x : point) pass.pass(x);
}

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Entity>
void visit_members(Pass& pass, Value& e) {
    pass.pass(e.kind);
    pass.pass(e.id);
    pass.pass(e.geometry);
    pass.pass(e.ids);
    pass.pass(e.role);
    pass.pass(e.radius);
    pass.pass(e.minor_radius);
    pass.pass(e.length);
    pass.pass(e.area);
    pass.pass(e.part);
}

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Diagnostic>
void visit_members(Pass& pass, Value& d) {
    pass.pass(d.code);
    pass.pass(d.message);
}

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, std::array<int, 3>>
void visit_members(Pass& pass, Value& triangle) {
    for (auto& vertex : triangle) pass.pass(vertex);
}

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Tessellation::Line>
void visit_members(Pass& pass, Value& line) {
    pass.pass(line.vertices);
    pass.pass(line.edge);
}

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Tessellation>
void visit_members(Pass& pass, Value& t) {
    pass.pass(t.vertices);
    pass.pass(t.triangles);
    pass.pass(t.faces);
    pass.pass(t.lines);
}

template <class Pass, class Value>
requires std::is_same_v<std::remove_const_t<Value>, Input>
void visit_members(Pass& pass, Value& input) {
    pass.pass(input.points.dimension);
    pass.pass(input.points.positions);
    pass.pass(input.points.labels);
    pass.pass(input.points.entities);
    pass.pass(input.path);
    pass.pass(input.format);
    pass.pass(input.unit);
    pass.pass(input.diagnostics);
    pass.pass(input.tessellation);
}

}  // namespace

std::string to_bytes(const Outcome& outcome) {
    Writer writer;
    writer.pass(outcome.index());
    if (const auto* error = std::get_if<Error>(&outcome)) {
        writer.pass(error->code());
        writer.pass(std::string(error->what()));
    } else {
        writer.pass(std::get<Input>(outcome));
    }
    writer.pass(kEnd);
    return writer.take();
}

std::optional<Outcome> from_bytes(std::string_view bytes) {
    Reader reader(bytes);
    std::size_t kind = 0;
    reader.pass(kind);
    std::optional<Outcome> outcome;
    if (kind == 0) {
        Input input;
        reader.pass(input);
        outcome = std::move(input);
    } else {
        ErrorCode code{};
        std::string what;
        reader.pass(code);
        reader.pass(what);
        outcome = Error(code, what);
    }
    std::uint64_t end = 0;
    reader.pass(end);
    return reader.good() && end == kEnd ? std::move(outcome) : std::nullopt;
}

}  // namespace insym
