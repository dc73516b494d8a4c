//! Every format written small and read back, every convention, every refusal, and the captures of the test data.

mod acceleration;
mod camera;
mod colour;
mod data;
mod depth;
mod encode;
mod field;
mod flow;
mod folder;
mod hidden;
mod hostile;
mod init;
mod kinds;
mod manifest;
mod maps;
mod overlay;
mod passes;
mod paths;
