// Oracle: known answers. Each text is written with its points in mind, after the contract in
// insym/read_points.hpp; each error has to name its line and have the right code.
#include "insym/read_points.hpp"

#include "insym/error.hpp"

#include <clocale>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace insym {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Input read(const std::string& text, const std::string& name = "p.xyz", const std::string& columns = "") {
    std::istringstream stream(text);
    return read_points(stream, name, {columns.empty() ? std::vector<Column>{} : parse_columns(columns)});
}

/// The message of the error that reading `text` has to give.
std::string failure(ErrorCode code, const std::string& text, const std::string& name = "p.xyz",
                    const std::string& columns = "") {
    try {
        read(text, name, columns);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no error for: " << text;
    return "";
}

std::string invalid(const std::string& text, const std::string& name = "p.xyz",
                    const std::string& columns = "") {
    return failure(ErrorCode::invalid_input, text, name, columns);
}

const Point kFirst = {1, 2, 3};
const Point kSecond = {-4.5, 0, 6e-3};

TEST(ReadPoints, AcceptsEverySeparator) {
    for (const char* text :
         {"1 2 3\n-4.5 0 6e-3\n", "1\t2\t3\n-4.5\t0\t6e-3", "1,2,3\n-4.5,0,6e-3\n", "1;2;3\n-4.5;0;6e-3\n",
          " 1 , 2 ,3 \n\t-4.5 , 0, 6e-3,\n", "1 2;3\n-4.5; 0 6e-3\n"}) {
        const Input input = read(text);
        EXPECT_EQ(input.points.dimension, 3) << text;
        EXPECT_THAT(input.points.positions, ElementsAre(kFirst, kSecond)) << text;
        EXPECT_THAT(input.points.labels, IsEmpty()) << text;
    }
}

TEST(ReadPoints, AcceptsEveryLineEndAndByteOrderMark) {
    for (const char* text : {"1 2 3\r\n-4.5 0 6e-3\r\n", "1 2 3\r-4.5 0 6e-3\r",
                             "\xEF\xBB\xBF"
                             "1 2 3\n-4.5 0 6e-3",
                             "\n\n1 2 3\n \t\n-4.5 0 6e-3\n"})
        EXPECT_THAT(read(text).points.positions, ElementsAre(kFirst, kSecond)) << text;
}

TEST(ReadPoints, PassesOverComments) {
    const Input input =
        read("# a title\n// another, in Latin-1: \xE9\n1 2 3 # behind\n-4.5 0 6e-3// behind\n,,,\n");
    EXPECT_THAT(input.points.positions, ElementsAre(kFirst, kSecond));
}

TEST(ReadPoints, TakesDimensionAndLabelsFromTheColumns) {
    const Input plane = read("1 2\n3 4\n");
    EXPECT_EQ(plane.points.dimension, 2);
    EXPECT_THAT(plane.points.positions, ElementsAre(Point{1, 2, 0}, Point{3, 4, 0}));
    const Input labelled = read("1 2 3 7\n-4.5 0 6e-3 -2.000e+00\n");
    EXPECT_EQ(labelled.points.dimension, 3);
    EXPECT_THAT(labelled.points.labels, ElementsAre(7, -2));
}

TEST(ReadPoints, TakesColumnsAsNamed) {
    const Input plane = read("1 2 7\n3 4 8\n", "p.txt", "x,y,label");
    EXPECT_EQ(plane.points.dimension, 2);
    EXPECT_THAT(plane.points.labels, ElementsAre(7, 8));
    const Input turned = read("name,3,2,1\n", "p.csv", "skip,z,Y,x");
    EXPECT_THAT(turned.points.positions, ElementsAre(kFirst));
    EXPECT_THAT(invalid("1 2 3\n1 2\n", "p.txt", "x,y,z"),
                HasSubstr("p.txt:2: 2 columns where --columns names 3"));
}

TEST(ReadPoints, RefusesImpossibleColumns) {
    for (const char* columns : {"", "x", "x,y,y", "x,y,w", "x,y,", "x y", "label,z", "x,y,label,label"}) {
        try {
            parse_columns(columns);
            ADD_FAILURE() << columns;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::invalid_option) << columns;
            EXPECT_THAT(error.what(), HasSubstr("--columns")) << columns;
        }
    }
}

TEST(ReadPoints, NumbersAreReadExactly) {
    const Input input = read("0.1 +1 -0\n1e-400 -1e-400 1.7976931348623157e308\n.5 5. 1E2\n");
    EXPECT_THAT(input.points.positions,
                ElementsAre(Point{0.1, 1, 0}, Point{0, 0, 1.7976931348623157e308}, Point{0.5, 5, 100}));
}

TEST(ReadPoints, DoesNotDependOnTheLocale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* comma_locale : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
        if (std::setlocale(LC_ALL, comma_locale) != nullptr) break;
    EXPECT_THAT(read("0.5 1.5\n").points.positions, ElementsAre(Point{0.5, 1.5, 0}));
    std::setlocale(LC_ALL, before.c_str());
}

TEST(ReadPoints, NamesTheLineOfWhatIsNoNumber) {
    EXPECT_THAT(invalid("1 2 3\n\n1 abc 3\n"), HasSubstr("p.xyz:3: 'abc' is not a number"));
    EXPECT_THAT(invalid("1 2 3\r\n1 2 NaN\r\n"), HasSubstr("p.xyz:2: 'NaN' is not a finite number"));
    EXPECT_THAT(invalid("1 2 3\n# c\n-inf 2 3\n"), HasSubstr("p.xyz:3: '-inf' is not a finite number"));
    EXPECT_THAT(invalid("1 2 1e999\n"), HasSubstr("p.xyz:1: '1e999' is not a finite number"));
    EXPECT_THAT(invalid("1 2 0x10\n"), HasSubstr("'0x10' is not a number"));
    EXPECT_THAT(invalid("1 2 1.2.3\n"), HasSubstr("'1.2.3' is not a number"));
    EXPECT_THAT(invalid("1 2 --3\n"), HasSubstr("'--3' is not a number"));
    EXPECT_THAT(invalid("1 2 \xC3\xA9" + std::string(100, 'a')), HasSubstr("'??aaa"));
}

TEST(ReadPoints, NamesTheLineOfAnotherWidth) {
    EXPECT_THAT(invalid("1 2\n3 4\n1 2 3 4\n"), HasSubstr("p.xyz:3: 4 columns where line 1 has 2"));
    EXPECT_THAT(invalid("# only\n1 2 3 4 5\n"), HasSubstr("p.xyz:2: 5 columns"));
    EXPECT_THAT(invalid("1.5\n2\n"), HasSubstr("p.xyz:1: 1 column;"));
    EXPECT_THAT(invalid("1,,3\n"), HasSubstr("p.xyz:1: the value of column 2 is empty"));
    EXPECT_THAT(invalid(",2,3\n"), HasSubstr("p.xyz:1: the value of column 1 is empty"));
    EXPECT_THAT(invalid("1,2,,\n"), HasSubstr("p.xyz:1: the value of column 3 is empty"));
}

TEST(ReadPoints, DecimalCommasAreNotMisread) {
    // Cut at every comma these would be x y z label.
    EXPECT_THAT(invalid("1,5;2,5\n"), HasSubstr("p.xyz:1: commas"));
    EXPECT_THAT(invalid("1,5 2,5\n"), HasSubstr("p.xyz:1: commas"));
}

TEST(ReadPoints, NamesTheLineOfABadLabel) {
    EXPECT_THAT(invalid("1 2 3 4\n1 2 3 4.5\n"), HasSubstr("p.xyz:2: the label '4.5'"));
    EXPECT_THAT(invalid("1 2 3 hole\n"), HasSubstr("p.xyz:1: the label 'hole'"));
    EXPECT_THAT(invalid("1 2 3 3000000000\n"), HasSubstr("the label '3000000000'"));
    EXPECT_THAT(invalid("1 2 3 nan\n"), HasSubstr("the label 'nan'"));
}

TEST(ReadPoints, NothingThereIsInvalid) {
    for (const char* text : {"", "\n\n", "# only a comment\n", "\xEF\xBB\xBF", "0\nempty molecule\n"})
        EXPECT_THAT(invalid(text), HasSubstr("there are no points in it"));
    EXPECT_THAT(invalid("x,y,z\n", "p.csv"), HasSubstr("there are no points in it"));
}

TEST(ReadPoints, HeaderOnlyInCsv) {
    EXPECT_THAT(read("X,Y,Z\n1,2,3\n", "p.CSV").points.positions, ElementsAre(kFirst));
    EXPECT_THAT(read("# title\n\"x\";\"y\";\"z\";kind\n1;2;3;4\n", "p.csv").points.labels, ElementsAre(4));
    EXPECT_THAT(invalid("x,y,z\n1,2,3\n", "p.txt"), HasSubstr("p.txt:1: 'x' is not a number"));
    EXPECT_THAT(invalid("x,y,z\na,b,c\n1,2,3\n", "p.csv"), HasSubstr("p.csv:2: 'a' is not a number"));
}

TEST(ReadPoints, HeaderThatContradictsTheColumnsIsAnError) {
    EXPECT_THAT(invalid("id,x,y,z\n9,1,2,3\n", "p.csv"), HasSubstr("p.csv:1: column 2 is named x"));
    EXPECT_THAT(read("id,x,y,z\n9,1,2,3\n", "p.csv", "skip,x,y,z").points.positions, ElementsAre(kFirst));
}

TEST(ReadPoints, BinaryDataCannotBeRead) {
    using namespace std::string_literals;
    EXPECT_THAT(failure(ErrorCode::cannot_read, "1 2 3\n\0\0\0"s), HasSubstr("binary data at byte 7"));
    EXPECT_THAT(failure(ErrorCode::cannot_read, "\x89PNG\r\n\x1a\n"s), HasSubstr("binary data at byte 7"));
    EXPECT_THAT(failure(ErrorCode::cannot_read,
                        "\xFF\xFE"
                        "1\0 \0"s),
                HasSubstr("UTF-16"));
}

TEST(ReadPoints, FormatAndNameComeFromTheEnding) {
    EXPECT_EQ(read("1 2\n", "a/b.XYZ").format, "xyz");
    EXPECT_EQ(read("1 2\n", "a.b/points").format, "txt");
    EXPECT_EQ(read("1 2\n", "-").format, "txt");
    EXPECT_EQ(read("1 2\n", "a/b.csv").path, "a/b.csv");
    EXPECT_FALSE(read("1 2\n").unit.has_value());
    EXPECT_THAT(invalid("1 a\n", "-"), HasSubstr("standard input:1: 'a'"));
}

TEST(ReadAtoms, ElementsBecomeTheirNumbers) {
    const Input input =
        read("5\nwater? # 1 2 3\nO 1 2 3\nH -4.5 0 6e-3 0.5 up\n\nfe 1 1 1\n82 2 2 2\nUuu 3 3 3\n\n");
    EXPECT_EQ(input.points.dimension, 3);
    EXPECT_THAT(input.points.labels, ElementsAre(8, 1, 26, 82, -1));
    EXPECT_EQ(input.points.positions[0], kFirst);
    EXPECT_EQ(input.points.positions[1], kSecond);
    EXPECT_THAT(input.diagnostics, IsEmpty());
}

TEST(ReadAtoms, UnknownSymbolsHaveStableNumbers) {
    EXPECT_THAT(read("3\n\nXb 0 0 0\nXa 1 0 0\nXb 2 0 0\n").points.labels, ElementsAre(-2, -1, -2));
    EXPECT_THAT(read("3\n\nXa 1 0 0\nXb 0 0 0\nXb 2 0 0\n").points.labels, ElementsAre(-1, -2, -2));
}

TEST(ReadAtoms, WrongCountNamesTheLine) {
    EXPECT_THAT(invalid("# made by hand\n3\nwater\nO 1 2 3\nH 1 1 1\n"),
                HasSubstr("p.xyz:2: the count is 3 but 2 atoms follow"));
    EXPECT_THAT(invalid("1\nwater\nO 1 2 3\nH 1 1 1\n"),
                HasSubstr("p.xyz:4: more atoms follow than the count 1 on line 1"));
    EXPECT_THAT(invalid("1\nwater\n"), HasSubstr("p.xyz:1: the count is 1 but 0 atoms follow"));
    EXPECT_THAT(invalid("99999999999999\nwater\nO 1 2 3\n"), HasSubstr("p.xyz:1:"));
}

TEST(ReadAtoms, CountBeforeBarePointsIsToldApart) {
    EXPECT_THAT(invalid("3\n0 0 0\n1 0 0\n0 1 0\n"),
                HasSubstr("p.xyz:3: `symbol x y z` is expected, as line 1 is a lone count"));
    EXPECT_THAT(invalid("4\n1\n2\n3\n"), HasSubstr("p.xyz:3: `symbol x y z` is expected"));
    EXPECT_THAT(invalid("1\n\nC 1 2 x\n"), HasSubstr("p.xyz:3: 'x' is not a number"));
}

TEST(ReadAtoms, OnlyTheFirstFrameIsRead) {
    const Input input = read("2\nframe 1\nC 1 2 3\nC -4.5 0 6e-3\n2\nframe 2\nC 0 0 0\nC 1 1 1\n");
    EXPECT_THAT(input.points.positions, ElementsAre(kFirst, kSecond));
    ASSERT_EQ(input.diagnostics.size(), 1U);
    EXPECT_EQ(input.diagnostics[0].code, "frames_skipped");
    EXPECT_THAT(input.diagnostics[0].message, HasSubstr("p.xyz:5:"));
}

/// What cannot be opened; each case makes its own path.
class ReadPointsFile : public testing::Test {
protected:
    // Another checkout may run the same test.
    ReadPointsFile() : folder_(testing::TempDir() + "insym_read_points_" + std::to_string(getpid())) {
        std::filesystem::create_directories(folder_);
    }
    ~ReadPointsFile() override { std::filesystem::remove_all(folder_); }

    static std::string failure_of(const std::string& path) {
        try {
            read_points_file(path);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::cannot_read);
            return error.what();
        }
        return "no error";
    }

    const std::string folder_;
};

TEST_F(ReadPointsFile, ReadsAFile) {
    const std::string path = folder_ + "/p.xyz";
    std::ofstream(path) << "1 2 3\n-4.5 0 6e-3\n";
    const Input input = read_points_file(path);
    EXPECT_THAT(input.points.positions, ElementsAre(kFirst, kSecond));
    EXPECT_EQ(input.path, path);
}

TEST_F(ReadPointsFile, SaysWhatCannotBeOpened) {
    EXPECT_THAT(failure_of(folder_ + "/none.xyz"), HasSubstr("none.xyz: cannot be opened: No such file"));
    EXPECT_THAT(failure_of(folder_), HasSubstr("is a directory"));
    EXPECT_THAT(failure_of("/dev/zero"), HasSubstr("/dev/zero: binary data at byte 1"));
}

TEST_F(ReadPointsFile, ReadsFilesLongerThanOneChunk) {
    const std::string path = folder_ + "/long.xyz";
    std::ofstream stream(path);
    constexpr int kCount = 100000;
    for (int i = 0; i < kCount; ++i) stream << i << " 0.25 -" << i << "\n";
    stream.close();
    const Input input = read_points_file(path);
    ASSERT_EQ(input.points.size(), static_cast<std::size_t>(kCount));
    for (int i = 0; i < kCount; ++i)
        ASSERT_EQ(input.points.positions[static_cast<std::size_t>(i)], (Point{double(i), 0.25, -double(i)}));
}

}  // namespace
}  // namespace insym
