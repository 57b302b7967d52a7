//! Names that stand beside their curves, and lines of text that fit a width.

use super::font;

/// Places for labels near their curves' ends `wanted` (pixels, downwards), no two closer than `gap`, between `first` and
/// `last` where they have room there.
pub(super) fn spread(wanted: &[f64], gap: f64, [first, last]: [f64; 2]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]));
    // labels that would overlap form a block around the mean of what they want
    let mut blocks: Vec<(Vec<usize>, f64)> = Vec::new();
    let top = |members: &[usize]| {
        let count = members.len() as f64;
        let mean = members.iter().map(|&k| wanted[k]).sum::<f64>() / count;
        let height = gap * (count - 1.0);
        (mean - 0.5 * height).min(last - height).max(first)
    };
    for k in order {
        let mut members = vec![k];
        while let Some((above, y)) = blocks.last()
            && y + gap * above.len() as f64 > top(&members)
        {
            members = above.iter().copied().chain(members).collect();
            blocks.pop();
        }
        let y = top(&members);
        blocks.push((members, y));
    }
    let mut places = vec![0.0; wanted.len()];
    for (members, y) in blocks {
        for (n, k) in members.into_iter().enumerate() {
            places[k] = y + gap * n as f64;
        }
    }
    places
}

/// `text` in lines of at most `width` pixels, broken between words.
pub(super) fn lines(text: &str, width: f64, size: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if font::width(line, size) + font::width(word, size) + 0.4 * size <= width => {
                *line += " ";
                *line += word;
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_distance_and_their_order() {
        let short = |wanted: &[f64]| spread(wanted, 12.0, [0.0, 300.0]);
        assert_eq!(short(&[50.0, 10.0, 200.0]), [50.0, 10.0, 200.0]);
        assert_eq!(short(&[100.0; 3]), [88.0, 100.0, 112.0]);
        let wanted = [299.0, 290.0, 295.0, 10.0, 11.0, 150.0, 160.0];
        let places = spread(&wanted, 12.0, [5.0, 295.0]);
        let mut order: Vec<usize> = (0..wanted.len()).collect();
        order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
        for pair in order.windows(2) {
            assert!(places[pair[1]] - places[pair[0]] >= 12.0, "{places:?}");
            assert!(wanted[pair[1]] >= wanted[pair[0]], "{places:?}");
        }
        assert!(places.iter().all(|y| (5.0..=295.0).contains(y)), "{places:?}");
    }

    #[test]
    fn text_is_broken_between_words() {
        assert_eq!(lines("one two three", 60.0, 10.0), ["one two", "three"]);
        assert_eq!(lines("unbreakable", 4.0, 10.0), ["unbreakable"]);
    }
}
