//! Messages that ROS prints, as rows.

use super::lines::{Line, Lines};
use crate::error::TableError;

/// The names of the columns.
const HEADER: &str = "stamp.secs,stamp.nsecs,orientation.x,orientation.y,orientation.z,orientation.w,angular_velocity.x,\
                      angular_velocity.y,angular_velocity.z";

/// Printed messages of the type sensor_msgs/Imu: blocks of `key: value` separated by `---`, the time in the stamp of the
/// header. Each row stands at the line of its z rate, or of its end where that is missing, so that messages name the
/// right line.
pub(crate) struct Echo<'t> {
    pub(crate) lines: Lines<'t>,
    is_begun: bool,
}

impl<'t> Echo<'t> {
    /// Of lines whose first was read.
    pub(crate) fn new(lines: Lines<'t>) -> Self {
        Self { lines, is_begun: false }
    }

    /// Reads the header, then a row for each message.
    pub(crate) fn advance(&mut self, line: &mut Line) -> Result<bool, TableError> {
        line.is_ended = true;
        if !self.is_begun {
            self.is_begun = true;
            (line.number, line.text) = (self.lines.number, HEADER.into());
            return Ok(true);
        }
        let mut cells: [String; 9] = Default::default();
        let mut first = None;
        while self.lines.advance()? {
            let trimmed = self.lines.text.trim();
            // a message that lacks a part is a row with empty cells
            if trimmed == "---" && cells.iter().any(|cell| !cell.is_empty()) {
                (line.number, line.text) = (self.lines.number, cells.join(","));
                return Ok(true);
            }
            let (key, value) = trimmed.split_once(':').unwrap_or((trimmed, ""));
            let place = match (key, first) {
                ("sec" | "secs", _) => 0,
                ("nanosec" | "nsecs", _) => 1,
                ("x", Some(first)) => first,
                ("y", Some(first)) => first + 1,
                ("z", Some(first)) => first + 2,
                ("w", Some(2)) => 5,
                ("orientation" | "angular_velocity" | "linear_acceleration", _) => {
                    first = [("orientation", 2), ("angular_velocity", 6)]
                        .iter()
                        .find(|(name, _)| *name == key)
                        .map(|(_, k)| *k);
                    continue;
                }
                _ => continue,
            };
            cells[place] = value.trim().into();
            if place == 8 {
                (line.number, line.text) = (self.lines.number, cells.join(","));
                return Ok(true);
            }
        }
        Ok(false)
    }
}
