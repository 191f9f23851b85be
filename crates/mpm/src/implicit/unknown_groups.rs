//! Which unknowns may be moved together: those that no balance feels together (Curtis, Powell & Reid 1974).

/// Each unknown goes to the first group with none that shares a row with it.
pub fn groups_of(rows_of_column: &Lists) -> Vec<Vec<usize>> {
    let count = rows_of_column.count();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    // The groups that have an unknown in each row, a bit each: so many words a row.
    let (mut words, mut taken) = (1, vec![0_u64; count]);
    let mut felt = vec![0_u64];
    for column in 0..count {
        felt.fill(0);
        for row in rows_of_column.of(column) {
            for (felt, taken) in felt.iter_mut().zip(&taken[row * words..]) {
                *felt |= taken;
            }
        }
        let free = felt.iter().position(|word| *word != u64::MAX);
        let word = free.unwrap_or_else(|| {
            taken = taken.chunks(words).flat_map(|row| row.iter().copied().chain([0])).collect();
            words += 1;
            felt.push(0);
            words - 1
        });
        let bit = felt[word].trailing_ones() as usize;
        for row in rows_of_column.of(column) {
            taken[row * words + word] |= 1 << bit;
        }
        let group = word * u64::BITS as usize + bit;
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(column);
    }
    groups
}

/// Lists of numbers one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists {
    /// Where each begins, and where the last one ends.
    starts: Vec<usize>,
    items: Vec<usize>,
}

impl Lists {
    /// The lists in which each number is found, of as many numbers as lists.
    pub fn turned(lists: &[Vec<usize>]) -> Self {
        let mut starts = vec![0; lists.len() + 1];
        for item in lists.iter().flatten() {
            starts[item + 1] += 1;
        }
        for item in 0..lists.len() {
            starts[item + 1] += starts[item];
        }
        let (mut next, mut items) = (starts.clone(), vec![0; starts[lists.len()]]);
        for (number, list) in lists.iter().enumerate() {
            for item in list {
                items[next[*item]] = number;
                next[*item] += 1;
            }
        }
        Self { starts, items }
    }

    /// How many there are.
    fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// One of them.
    pub fn of(&self, number: usize) -> &[usize] {
        &self.items[self.starts[number]..self.starts[number + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_of_a_group_share_no_row_and_there_are_no_more_groups_than_a_row_feels() {
        // Bands of a width, and for more groups than a word has bits a row that feels all.
        for (count, reach, full) in [(40, 2, false), (150, 40, false), (70, 1, true)] {
            let felt = |row: usize| row.saturating_sub(reach)..(row + reach + 1).min(count);
            let mut columns: Vec<Vec<usize>> = (0..count).map(|row| felt(row).collect()).collect();
            if full {
                columns[count - 1] = (0..count).collect();
            }
            let rows = Lists::turned(&columns);
            assert!(
                columns
                    .iter()
                    .enumerate()
                    .all(|(row, felt)| felt.iter().all(|one| rows.of(*one).contains(&row)))
            );
            let groups = groups_of(&rows);
            assert_eq!(groups.len(), if full { count } else { 2 * reach + 1 });
            assert_eq!(groups.iter().map(Vec::len).sum::<usize>(), count, "each unknown once");
            for (row, felt) in columns.iter().enumerate() {
                for group in &groups {
                    let shared = group.iter().filter(|one| felt.contains(one)).count();
                    assert!(shared < 2, "row {row} feels {shared} of a group");
                }
            }
        }
    }
}
