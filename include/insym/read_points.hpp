// Readers for bare points in text.
#pragma once

#include "insym/export.hpp"
#include "insym/point_set.hpp"

#include <iosfwd>
#include <string>
#include <vector>

namespace insym {

/// The meaning of a column of a text file.
enum class Column { x, y, z, label, skip };

struct ReadPointsOptions {
    /// One meaning for each column; empty: 2 columns are x y, 3 are x y z, 4 are x y z label.
    std::vector<Column> columns;
};

/// Parses "x,y,label" and the like; `skip` leaves a column out. Throws Error(invalid_option).
INSYM_EXPORT std::vector<Column> parse_columns(const std::string& text);

/// Reads points from text: columns parted by blanks, tabs, commas or semicolons; what follows # or //
/// and blank lines are passed over; one header line of names is accepted in .csv, and is an error if
/// it names x, y or z elsewhere than they are read. Decimal commas and empty values are errors.
///
/// The chemists' .xyz (a count, a comment, then `symbol x y z`, further columns passed over) is
/// recognised by its first line, a lone count. Labels are atomic numbers; symbols that are no
/// elements get -1, -2, ... in alphabetical order. Of several frames the first is read, with a
/// diagnostic (frames_skipped).
///
/// `name` is used in messages and, by its ending, as the format. Coordinates are kept as read.
/// Throws Error: cannot_read (no such file, a directory, binary data), invalid_input (no points, a
/// word that is not a finite number, lines of different lengths), each naming file and line.
INSYM_EXPORT Input read_points(std::istream& stream, const std::string& name,
                               const ReadPointsOptions& options = {});

/// The same from a file.
INSYM_EXPORT Input read_points_file(const std::string& path, const ReadPointsOptions& options = {});

}  // namespace insym
