#include "insym/read_points.hpp"

#include "insym/error.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "points/elements.hpp"

namespace insym {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

std::string to_lower(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return lower;
}

std::string display_name(const std::string& name) {
    return name == "-" ? "standard input" : name;
}

std::string format_of(const std::string& name) {
    const std::string ending = to_lower(std::filesystem::path(name).extension().string());
    return ending.size() > 1 ? ending.substr(1) : "txt";
}

/// A word of the input as it may stand in a message: short, printable, in quotes.
std::string in_quotes(std::string_view word) {
    constexpr std::size_t kLongest = 30;
    std::string text(word.substr(0, kLongest));
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return "'" + text + (word.size() > kLongest ? "...'" : "'");
}

/// Control characters that no text of numbers holds.
bool is_binary(char c) {
    return (c >= '\0' && c < ' ' && c != '\t' && c != '\n' && c != '\v' && c != '\f' && c != '\r') ||
           c == 0x7f;
}

[[noreturn]] void fail_binary(const std::string& name, std::string_view start, std::size_t byte) {
    if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF"))
        throw Error(ErrorCode::cannot_read, name + ": the text is UTF-16; save it as UTF-8");
    throw Error(ErrorCode::cannot_read, name + ": binary data at byte " + std::to_string(byte) +
                                            "; points are read from text, one point on each line");
}

/// The whole stream. Looks for binary data on the way, so that an endless device ends at once.
std::string read_text(std::istream& stream, const std::string& name) {
    std::string text;
    while (stream) {
        const std::size_t start = text.size();
        text.resize(start + kChunk);
        stream.read(text.data() + start, static_cast<std::streamsize>(kChunk));
        text.resize(start + static_cast<std::size_t>(stream.gcount()));
        const auto first = text.begin() + static_cast<std::ptrdiff_t>(start);
        const auto binary = std::find_if(first, text.end(), is_binary);
        if (binary != text.end())
            fail_binary(name, text, static_cast<std::size_t>(binary - text.begin()) + 1);
    }
    if (stream.bad()) throw Error(ErrorCode::cannot_read, name + ": reading failed part way");
    return text;
}

/// The number that the whole word is; infinite where it is too large; none if it is no number.
std::optional<double> to_number(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
    if (error != std::errc::result_out_of_range) return value;
    // Too small for a double is as good as zero; only the exponent, or a leading 0., tells.
    const std::size_t exponent = word.find_first_of("eE");
    const std::string_view digits = word.substr(word.starts_with('-') ? 1 : 0);
    const bool tiny = exponent != std::string_view::npos ? word.substr(exponent + 1).starts_with('-')
                                                         : digits.starts_with('0') || digits.starts_with('.');
    return tiny ? 0 : std::numeric_limits<double>::infinity();
}

/// The non-negative whole number that the word is; none if it is anything else.
std::optional<std::size_t> to_count(std::string_view word) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error != std::errc()) return std::nullopt;
    return value;
}

std::string_view column_name(Column column) {
    constexpr std::string_view kNames[] = {"x", "y", "z", "label", "skip"};
    return kNames[static_cast<std::size_t>(column)];
}

std::string column_list(const std::vector<Column>& columns) {
    std::string list;
    for (const Column column : columns) list.append(list.empty() ? "" : ",").append(column_name(column));
    return list;
}

bool contains(const std::vector<Column>& columns, Column column) {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
}

/// x and y once, z and label at most once.
void check_columns(const std::vector<Column>& columns) {
    for (const Column column : {Column::x, Column::y, Column::z, Column::label}) {
        const auto times = std::count(columns.begin(), columns.end(), column);
        if (times > 1)
            throw Error(ErrorCode::invalid_option,
                        "--columns: " + std::string(column_name(column)) + " stands there twice");
        if (times == 0 && (column == Column::x || column == Column::y))
            throw Error(ErrorCode::invalid_option, "--columns: " + std::string(column_name(column)) +
                                                       " is not among them; x and y have to be");
    }
}

/// Cuts one text into points, line by line; knows where it is for the messages.
class TextReader {
public:
    TextReader(std::string_view text, const std::string& name, const ReadPointsOptions& options)
        : text_(text),
          name_(display_name(name)),
          is_csv_(format_of(name) == "csv"),
          columns_(options.columns) {
        if (text_.starts_with(kUtf8Mark)) text_.remove_prefix(kUtf8Mark.size());
    }

    PointSet read() {
        if (next_words()) {
            const auto count = words_.size() == 1 && columns_.empty() ? to_count(words_[0]) : std::nullopt;
            count ? read_atoms(*count) : read_rows();
        }
        if (points_.positions.empty())
            throw Error(ErrorCode::invalid_input, name_ + ": there are no points in it");
        return std::move(points_);
    }

    std::vector<Diagnostic> take_diagnostics() { return std::move(diagnostics_); }

private:
    [[noreturn]] void fail(const std::string& sentence) const { fail_at(line_number_, sentence); }
    [[noreturn]] void fail_at(std::size_t line, const std::string& sentence) const {
        throw Error(ErrorCode::invalid_input, name_ + ":" + std::to_string(line) + ": " + sentence);
    }

    // Lines and words -------------------------------------------------------------------------

    /// Steps to the next line, ended by LF, CR LF or CR; false at the end of the text.
    bool next_line() {
        if (text_.empty()) return false;
        const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
        line_ = text_.substr(0, end);
        text_.remove_prefix(end);
        text_.remove_prefix(text_.starts_with("\r\n") ? 2 : std::min<std::size_t>(text_.size(), 1));
        ++line_number_;
        return true;
    }

    /// Steps to the next line that holds anything but a comment, and cuts it into words.
    bool next_words() {
        while (next_line()) {
            line_ = line_.substr(0, std::min(line_.find('#'), line_.find("//")));
            cut_words();
            if (!words_.empty()) return true;
        }
        return false;
    }

    void cut_words() {
        words_.clear();
        commas_ = others_ = false;
        std::size_t at = 0;
        while (at < line_.size()) {
            const std::size_t begin = skip(at, true);
            check_gap(line_.substr(at, begin - at), begin == line_.size());
            at = skip(begin, false);
            if (at > begin) words_.push_back(line_.substr(begin, at - begin));
        }
        if (commas_ && others_)
            fail("commas and other separators are mixed; use one kind, and a point in decimal numbers");
    }

    /// The first place from `at` on that is no separator (or no word).
    std::size_t skip(std::size_t at, bool separators) const {
        const auto is_separator = [](char c) {
            return c == ' ' || c == ',' || c == ';' || c == '\t' || c == '\v' || c == '\f';
        };
        while (at < line_.size() && is_separator(line_[at]) == separators) ++at;
        return at;
    }

    /// Values left out must not shift the others into the wrong column; "1,5;2,5" must not be four
    /// numbers. One separator at the end of a line, and rows of bare separators, are harmless.
    void check_gap(std::string_view gap, bool at_end) {
        const auto marks = std::count_if(gap.begin(), gap.end(), [](char c) { return c == ',' || c == ';'; });
        const bool at_start = words_.empty();
        if (at_start && at_end) return;
        if (marks > (at_start ? 0 : 1))
            fail("the value of column " + std::to_string(words_.size() + 1) + " is empty");
        if (at_start || at_end) return;
        (gap.find(',') != gap.npos ? commas_ : others_) = true;
    }

    // Rows of numbers -------------------------------------------------------------------------

    void read_rows() {
        const bool header = is_csv_ && std::none_of(words_.begin(), words_.end(), to_number);
        const std::size_t header_line = line_number_;
        const std::vector<std::string> names(words_.begin(), words_.end());
        if (header && !next_words()) return;
        choose_columns();
        if (header) check_header(names, header_line);
        const std::size_t first_line = line_number_;
        points_.dimension = contains(columns_, Column::z) ? 3 : 2;
        do {
            if (words_.size() != columns_.size()) fail_width(first_line);
            read_row();
        } while (next_words());
    }

    void choose_columns() {
        columns_given_ = !columns_.empty();
        if (columns_given_) return;
        if (words_.size() < 2 || words_.size() > 4)
            fail(columns_text(words_.size()) +
                 "; 2 are read as x y, 3 as x y z, 4 as x y z label, others need --columns");
        constexpr Column kDefault[] = {Column::x, Column::y, Column::z, Column::label};
        columns_.assign(kDefault, kDefault + words_.size());
    }

    /// A header that names x, y or z elsewhere than they are read would mean wrong points.
    void check_header(const std::vector<std::string>& names, std::size_t header_line) const {
        if (columns_given_) return;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const std::string name = to_lower(names[i].size() > 2 && names[i].front() == '"'
                                                  ? std::string_view(names[i]).substr(1, names[i].size() - 2)
                                                  : std::string_view(names[i]));
            const bool coordinate = name == "x" || name == "y" || name == "z";
            if (coordinate && (i >= columns_.size() || name != column_name(columns_[i])))
                fail_at(header_line, "column " + std::to_string(i + 1) + " is named " + name +
                                         " but the columns are read as " + column_list(columns_) +
                                         "; say with --columns what they are");
        }
    }

    [[noreturn]] void fail_width(std::size_t first_line) const {
        if (columns_given_)
            fail(columns_text(words_.size()) + " where --columns names " + std::to_string(columns_.size()));
        fail(columns_text(words_.size()) + " where line " + std::to_string(first_line) + " has " +
             std::to_string(columns_.size()) + "; every line needs the same");
    }

    static std::string columns_text(std::size_t count) {
        return std::to_string(count) + (count == 1 ? " column" : " columns");
    }

    void read_row() {
        Point point{};
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (columns_[i] <= Column::z)
                point[static_cast<std::size_t>(columns_[i])] = coordinate(words_[i]);
            if (columns_[i] == Column::label) points_.labels.push_back(label(words_[i]));
        }
        points_.positions.push_back(point);
    }

    double coordinate(std::string_view word) const {
        const std::optional<double> value = to_number(word);
        if (!value)
            fail(in_quotes(word) + " is not a number; lines of words are made comments by a leading #");
        if (!std::isfinite(*value))
            fail(in_quotes(word) + " is not a finite number; remove the point or mend it");
        return *value;
    }

    int label(std::string_view word) const {
        // Many programs write every column as a floating-point number, so 3.000e+00 is 3.
        const std::optional<double> value = to_number(word);
        constexpr double kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
        if (!value || !(*value >= kLeast && *value <= kMost) || *value != std::trunc(*value))
            fail("the label " + in_quotes(word) + " is not a whole number of at most 32 bits");
        return static_cast<int>(*value);
    }

    // The chemists' .xyz ----------------------------------------------------------------------

    /// A count, a comment line, then `symbol x y z` and perhaps more columns on every line.
    void read_atoms(std::size_t count) {
        const std::size_t count_line = line_number_;
        next_line();
        std::vector<std::string> symbols;
        while (symbols.size() < count && next_words()) {
            if (words_.size() < 4 || (to_number(words_[0]) && !to_count(words_[0])))
                fail("`symbol x y z` is expected, as line " + std::to_string(count_line) +
                     " is a lone count; without that line and the next, bare points are read");
            symbols.emplace_back(words_[0]);
            points_.positions.push_back(
                {coordinate(words_[1]), coordinate(words_[2]), coordinate(words_[3])});
        }
        if (symbols.size() < count)
            fail_at(count_line, "the count is " + std::to_string(count) + " but " +
                                    std::to_string(symbols.size()) +
                                    (symbols.size() == 1 ? " atom follows" : " atoms follow"));
        label_atoms(symbols);
        check_rest(count, count_line);
    }

    /// Elements and bare numbers become atomic numbers; other symbols -1, -2, ... in the order of
    /// the alphabet, so that the same symbols always give the same labels.
    void label_atoms(const std::vector<std::string>& symbols) {
        std::map<std::string, int> labels;
        for (const std::string& symbol : symbols) labels.emplace(symbol, 0);
        int next_unknown = -1;
        for (auto& [symbol, label] : labels) {
            const int element = atomic_number(symbol);
            label = element != 0 ? element : to_count(symbol) ? this->label(symbol) : next_unknown--;
        }
        for (const std::string& symbol : symbols) points_.labels.push_back(labels[symbol]);
    }

    /// After the atoms: nothing, or further frames of a film, of which the first is the input.
    void check_rest(std::size_t count, std::size_t count_line) {
        if (!next_words()) return;
        if (words_.size() != 1 || !to_count(words_[0]))
            fail("more atoms follow than the count " + std::to_string(count) + " on line " +
                 std::to_string(count_line));
        diagnostics_.push_back(
            {"frames_skipped", name_ + ":" + std::to_string(line_number_) +
                                   ": only the first frame is read; another one begins here"});
    }

    std::string_view text_;  ///< what is still to be read
    std::string name_;
    bool is_csv_;
    std::vector<Column> columns_;
    bool columns_given_ = false;

    std::string_view line_;
    std::size_t line_number_ = 0;
    std::vector<std::string_view> words_;
    bool commas_ = false;  ///< the line parts values by commas
    bool others_ = false;  ///< the line parts values by blanks or semicolons alone

    PointSet points_;
    std::vector<Diagnostic> diagnostics_;
};

}  // namespace

std::vector<Column> parse_columns(const std::string& text) {
    std::vector<Column> columns;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string name = to_lower(std::string_view(text).substr(at, end - at));
        std::optional<Column> found;
        for (const Column column : {Column::x, Column::y, Column::z, Column::label, Column::skip})
            if (name == column_name(column)) found = column;
        if (!found)
            throw Error(ErrorCode::invalid_option,
                        "--columns: " + in_quotes(name) +
                            " is unknown; use x, y, z, label and skip, as in x,y,label");
        columns.push_back(*found);
        at = end + 1;
    }
    check_columns(columns);
    return columns;
}

Input read_points(std::istream& stream, const std::string& name, const ReadPointsOptions& options) {
    if (!options.columns.empty()) check_columns(options.columns);
    const std::string text = read_text(stream, display_name(name));
    TextReader reader(text, name, options);
    Input input;
    input.points = reader.read();
    input.path = name;
    input.format = format_of(name);
    input.diagnostics = reader.take_diagnostics();
    return input;
}

Input read_points_file(const std::string& path, const ReadPointsOptions& options) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw Error(ErrorCode::cannot_read, path + ": is a directory; name a file of points in it");
    errno = 0;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        const int reason = errno != 0 ? errno : ENOENT;
        throw Error(ErrorCode::cannot_read,
                    path + ": cannot be opened: " + std::generic_category().message(reason));
    }
    return read_points(stream, path, options);
}

}  // namespace insym
