//! The name that was meant by a misspelt one.

/// Edit distance up to which a name is taken for a misspelt one.
const CLOSE: f64 = 0.6;

/// The candidate nearest to a misspelt word, if one is near at all.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| {
            let alike =
                strsim::normalized_damerau_levenshtein(&word.to_lowercase(), &candidate.to_lowercase());
            (alike, candidate)
        })
        .filter(|(alike, _)| *alike >= CLOSE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
