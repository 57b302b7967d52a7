//! Messages that ROS prints, as rows.

/// The rows of printed messages of the type sensor_msgs/Imu: blocks of `key: value` parted by `---`, the time in the stamp of
/// the header, the rates below `angular_velocity:`. `None` of any other text. Each row stands at the line of the z rate, so
/// that messages name the right line.
pub(super) fn table(text: &str) -> Option<String> {
    let is_echo = text.lines().any(|line| line.trim() == "---") && text.contains("angular_velocity:");
    if !is_echo {
        return None;
    }
    let mut table = String::new();
    let (mut seconds, mut nanoseconds, mut rates) = (None, None, [None; 3]);
    let mut inside = false;
    for (k, line) in text.lines().enumerate() {
        let trimmed = line.trim();
        let (key, value) = trimmed.split_once(':').map_or((trimmed, ""), |(key, value)| (key, value.trim()));
        match key {
            "sec" | "secs" => seconds = Some(value),
            "nanosec" | "nsecs" => nanoseconds = Some(value),
            "angular_velocity" => inside = true,
            "x" if inside => rates[0] = Some(value),
            "y" if inside => rates[1] = Some(value),
            "z" if inside => {
                inside = false;
                rates[2] = Some(value);
                if let (Some(seconds), Some(nanoseconds), [Some(x), Some(y), Some(z)]) =
                    (seconds, nanoseconds, rates)
                {
                    table += &format!("{seconds},{nanoseconds},{x},{y},{z}");
                }
            }
            _ => {}
        }
        if k == 0 {
            table += "stamp.secs,stamp.nsecs,angular_velocity.x,angular_velocity.y,angular_velocity.z";
        }
        table.push('\n');
    }
    Some(table)
}
