//! What the acceptance tests share: the reference program that is the truth to
//! test against, and the papers' claims as numbers.

pub mod claims;
pub mod reference;
