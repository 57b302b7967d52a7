//! Names that stand beside their curves, and lines of text that fit a width.

/// Places for labels near their curves' ends `wanted` (pixels, downwards), no two closer than `gap`, between `first` and
/// `last` where they have room there.
pub(super) fn spread(wanted: &[i32], gap: i32, [first, last]: [i32; 2]) -> Vec<i32> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by_key(|&k| wanted[k]);
    // labels that would overlap form a block around the mean of what they want
    let mut blocks: Vec<(Vec<usize>, i32)> = Vec::new();
    let top = |members: &[usize]| {
        let count = members.len() as i32;
        let mean = members.iter().map(|&k| wanted[k]).sum::<i32>() / count;
        let height = gap * (count - 1);
        (mean - height / 2).min(last - height).max(first)
    };
    for k in order {
        let mut members = vec![k];
        while let Some((above, y)) = blocks.last()
            && y + gap * above.len() as i32 > top(&members)
        {
            members = above.iter().copied().chain(members).collect();
            blocks.pop();
        }
        let y = top(&members);
        blocks.push((members, y));
    }
    let mut places = vec![0; wanted.len()];
    for (members, y) in blocks {
        for (n, k) in members.into_iter().enumerate() {
            places[k] = y + gap * n as i32;
        }
    }
    places
}

/// `text` in lines of at most `most` characters, broken between words.
pub(super) fn lines(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
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
        assert_eq!(spread(&[50, 10, 200], 12, [0, 300]), [50, 10, 200]);
        assert_eq!(spread(&[100, 100, 100], 12, [0, 300]), [88, 100, 112]);
        let wanted = [299, 290, 295, 10, 11, 150, 160];
        let places = spread(&wanted, 12, [5, 295]);
        let mut order: Vec<usize> = (0..wanted.len()).collect();
        order.sort_by_key(|&k| places[k]);
        for pair in order.windows(2) {
            assert!(places[pair[1]] - places[pair[0]] >= 12, "{places:?}");
            assert!(wanted[pair[1]] >= wanted[pair[0]], "{places:?}");
        }
        assert!(places.iter().all(|y| (5..=295).contains(y)), "{places:?}");
    }

    #[test]
    fn text_is_broken_between_words() {
        assert_eq!(lines("one two three", 8), ["one two", "three"]);
        assert_eq!(lines("unbreakable", 4), ["unbreakable"]);
    }
}
