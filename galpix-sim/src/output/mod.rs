//! What is written: pages, films, pictures, and files that are whole or not there.

pub mod figure;
pub mod film;
pub mod html;
pub mod save;
