//! One self-contained HTML page with figures, pictures and plots.
//!
//! Pictures are inside the page and plots are drawn as SVG, so that the page can be sent around as one file. It is
//! readable on a phone, in light and dark, printed, and without JavaScript.

use super::COLORS;
use super::svg::{Histogram, Plot};
use crate::render::encode_png;
use crate::{Error, export};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;
use std::io::{self, Write};
use std::path::Path;

/// A page.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Heading and title of the page.
    pub title: String,
    /// A sentence below it.
    pub summary: String,
    /// What matters most, in large type below the summary.
    pub facts: Vec<Fact>,
    /// Sections, in order.
    pub sections: Vec<Section>,
}

/// A fact in a line.
#[derive(Clone, Debug, Default)]
pub struct Fact {
    /// What it is: `vertices`.
    pub name: String,
    /// The number and its unit: `3,241`.
    pub value: String,
}

/// A part of a page.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Heading.
    pub heading: String,
    /// Content, in order.
    pub blocks: Vec<Block>,
}

/// A piece of a section.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// Names and values, one a line.
    Rows(Vec<[String; 2]>),
    /// A list.
    List(Vec<String>),
    /// A table; numbers are aligned to the right.
    Table {
        /// Headings of the columns.
        columns: Vec<String>,
        /// Rows of as many cells; the first cell of each may have the color of a number (see [`Series::color`](super::Series::color)).
        rows: Vec<(Option<usize>, Vec<String>)>,
    },
    /// Shares of a whole, as bars.
    Bars(Vec<Bar>),
    /// Pictures beside each other where there is room.
    Pictures(Vec<Picture>),
    /// Views of one thing: beside each other on any screen.
    Views(Vec<Picture>),
    /// A picture so wide that a small screen scrolls it.
    Strip(Picture),
    /// Lines over an axis.
    Plot(Plot),
    /// Counts of values.
    Histogram(Histogram),
}

/// A share of a whole.
#[derive(Clone, Debug, Default)]
pub struct Bar {
    /// What it is.
    pub name: String,
    /// How much, with its unit.
    pub value: String,
    /// Length, `0..=1`.
    pub share: f64,
}

/// What a picture shows.
#[derive(Clone, Debug)]
pub enum Image {
    /// Pixels, sRGB.
    Still(RgbImage),
    /// The bytes of a GIF, and its size in pixels.
    Gif(Vec<u8>, [u32; 2]),
}

/// A picture with a caption.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it shows.
    pub image: Image,
    /// What is seen; also the description for those who cannot see it.
    pub caption: String,
}

impl Report {
    /// Writes the page, whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::Write`] with `path`.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        export::write_atomic(path, |writer| self.write_to(writer))
    }

    /// Writes the page to a writer.
    ///
    /// # Errors
    ///
    /// The writer's.
    pub fn write_to(&self, mut out: impl Write) -> io::Result<()> {
        let title = escape(&self.title);
        let style = include_str!("style.css");
        writeln!(out, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">")?;
        writeln!(out, "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">")?;
        writeln!(out, "<title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<main>")?;
        writeln!(out, "<header>\n<h1>{title}</h1>")?;
        if !self.summary.is_empty() {
            writeln!(out, "<p class=\"summary\">{}</p>", escape(&self.summary))?;
        }
        if !self.facts.is_empty() {
            writeln!(out, "<dl class=\"figures\">")?;
            for f in &self.facts {
                let (name, value) = (escape(&f.name), escape(&f.value));
                writeln!(out, "<div><dt>{name}</dt><dd>{value}</dd></div>")?;
            }
            writeln!(out, "</dl>")?;
        }
        writeln!(out, "</header>")?;
        for section in &self.sections {
            writeln!(out, "<section>\n<h2>{}</h2>", escape(&section.heading))?;
            for block in &section.blocks {
                block.write_to(&mut out)?;
            }
            writeln!(out, "</section>")?;
        }
        writeln!(out, "</main>\n</body>\n</html>")
    }
}

impl Block {
    fn write_to(&self, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Text(text) => writeln!(out, "<p>{}</p>", escape(text)),
            Self::Rows(rows) => {
                writeln!(out, "<dl class=\"rows\">")?;
                for [name, value] in rows {
                    writeln!(out, "<div><dt>{}</dt><dd>{}</dd></div>", escape(name), escape(value))?;
                }
                writeln!(out, "</dl>")
            }
            Self::List(items) => {
                writeln!(out, "<ul>")?;
                items.iter().try_for_each(|item| writeln!(out, "<li>{}</li>", escape(item)))?;
                writeln!(out, "</ul>")
            }
            Self::Table { columns, rows } => write_table(out, columns, rows),
            Self::Bars(bars) => write_bars(out, bars),
            Self::Strip(picture) => {
                write!(out, "<div class=\"strip\">")?;
                picture.write_to(out)?;
                writeln!(out, "</div>")
            }
            Self::Pictures(pictures) => write_pictures(out, "pictures", pictures),
            Self::Views(pictures) => write_pictures(out, "pictures views", pictures),
            Self::Plot(plot) => plot.write_to(out),
            Self::Histogram(histogram) => histogram.write_to(out),
        }
    }
}

fn write_pictures(out: &mut impl Write, class: &str, pictures: &[Picture]) -> io::Result<()> {
    writeln!(out, "<div class=\"{class}\">")?;
    pictures.iter().try_for_each(|p| p.write_to(out))?;
    writeln!(out, "</div>")
}

fn write_bars(out: &mut impl Write, bars: &[Bar]) -> io::Result<()> {
    writeln!(out, "<div class=\"bars\">")?;
    for Bar { name, value, share } in bars {
        let (name, value, percent) = (escape(name), escape(value), 100.0 * share.clamp(0.0, 1.0));
        write!(out, "<div><span>{name}</span><b><i style=\"width:{percent:.1}%\"></i></b>")?;
        writeln!(out, "<span>{value}</span></div>")?;
    }
    writeln!(out, "</div>")
}

type Rows = [(Option<usize>, Vec<String>)];

fn write_table(out: &mut impl Write, columns: &[String], rows: &Rows) -> io::Result<()> {
    writeln!(out, "<div class=\"wide\"><table>\n<thead><tr>")?;
    for column in columns {
        writeln!(out, "<th>{}</th>", escape(column))?;
    }
    writeln!(out, "</tr></thead>\n<tbody>")?;
    for (color, row) in rows {
        write!(out, "<tr>")?;
        for (i, cell) in row.iter().enumerate() {
            let number = cell.replace(',', "").parse::<f64>().is_ok();
            let class = if number { " class=\"number\"" } else { "" };
            let dot = color.filter(|_| i == 0).map(|c| format!("<i class=\"dot c{}\"></i>", c % COLORS));
            write!(out, "<td{class}>{}{}</td>", dot.unwrap_or_default(), escape(cell))?;
        }
        writeln!(out, "</tr>")?;
    }
    writeln!(out, "</tbody>\n</table></div>")
}

impl Picture {
    fn write_to(&self, out: &mut impl Write) -> io::Result<()> {
        let (kind, bytes, [width, height]) = match &self.image {
            Image::Gif(bytes, size) => ("gif", bytes.clone(), *size),
            Image::Still(image) => {
                let mut png = Vec::new();
                encode_png(image, &mut png)?;
                ("png", png, [image.width(), image.height()])
            }
        };
        let caption = escape(&self.caption);
        // Moving pictures are coarse: they are not stretched far.
        let limit =
            if kind == "gif" { format!(" style=\"max-width:{}px\"", width * 5 / 4) } else { String::new() };
        write!(out, "<figure{limit}><img width=\"{width}\" height=\"{height}\" alt=\"{caption}\" ")?;
        write!(out, "src=\"data:image/{kind};base64,{}\">", STANDARD.encode(bytes))?;
        writeln!(out, "<figcaption>{caption}</figcaption></figure>")
    }
}

/// Text as it may stand in HTML, also within quotes.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Control characters are not HTML.
            c if c.is_control() && c != '\n' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::svg::Series;
    use super::*;

    fn report() -> Report {
        let waves = |name: &str, phase: f64| Series {
            name: name.to_owned(),
            color: 1,
            points: (0..50_u8)
                .map(|i| [f64::from(i) / 30.0, libm::sin(f64::from(i) * 0.3 + phase)])
                .collect(),
        };
        let picture =
            Picture { image: Image::Still(RgbImage::new(4, 3)), caption: "a \"black\" <box>".to_owned() };
        let blocks = vec![
            Block::Text("1 < 2 & 3".to_owned()),
            Block::Rows(vec![["clip".to_owned(), "<script>alert(1)</script>".to_owned()]]),
            Block::Table {
                columns: vec!["region".to_owned(), "Hz".to_owned()],
                rows: vec![(Some(2), vec!["tail".to_owned(), "2.5".to_owned()])],
            },
            Block::Pictures(vec![picture.clone()]),
            Block::Views(vec![picture.clone()]),
            Block::Strip(picture),
            Block::List(vec!["<b>".to_owned()]),
            Block::Bars(vec![Bar { name: "a & b".to_owned(), value: "1 kB".to_owned(), share: 0.5 }]),
            Block::Plot(Plot {
                title: "offset".to_owned(),
                x_label: "time, s".to_owned(),
                y_label: "cm".to_owned(),
                series: vec![waves("sinew", 0.0), waves("skinning", 1.0)],
            }),
            Block::Histogram(Histogram::of("softness", "softness", [0.1, 0.5, 0.52, f64::NAN, 0.9], 10)),
        ];
        Report {
            title: "Fox & friends".to_owned(),
            summary: "What the baker made of it.".to_owned(),
            facts: vec![Fact { name: "vertices".to_owned(), value: "1,728".to_owned() }],
            sections: vec![Section { heading: "Motion".to_owned(), blocks }],
        }
    }

    fn html(report: &Report) -> String {
        let mut bytes = Vec::new();
        report.write_to(&mut bytes).expect("memory");
        String::from_utf8(bytes).expect("text")
    }

    /// Whether every element that is opened is closed, in order.
    fn is_nested(html: &str) -> bool {
        let mut open = Vec::new();
        for tag in html.split('<').skip(1) {
            let Some((tag, _)) = tag.split_once('>') else { return false };
            let name = tag.split([' ', '\n']).next().unwrap_or_default();
            let void = ["!doctype", "meta", "img"].contains(&name) || tag.ends_with('/');
            if let Some(closed) = name.strip_prefix('/') {
                if open.pop() != Some(closed) {
                    return false;
                }
            } else if !void {
                open.push(name);
            }
        }
        open.is_empty()
    }

    #[test]
    fn the_page_is_well_formed_and_self_contained() {
        let page = html(&report());
        assert!(is_nested(&page), "{page}");
        for outside in ["http://", "https://", "src=\"/", "url(", "@import", "<script"] {
            // The name of SVG's vocabulary is not a place to load from.
            let rest = page.replace("http://www.w3.org/2000/svg", "");
            assert!(!rest.contains(outside), "{outside} in the page");
        }
        assert!(page.contains("data:image/png;base64,iVBOR"), "the picture is inside");
        assert!(page.contains("alt=\"a &quot;black&quot; &lt;box&gt;\""), "texts are escaped");
        assert!(page.contains("&lt;script&gt;alert(1)"), "values are escaped");
    }

    #[test]
    fn empty_reports_and_plots_are_written() {
        let empty = Report {
            sections: vec![Section {
                heading: String::new(),
                blocks: vec![
                    Block::Plot(Plot::default()),
                    Block::Histogram(Histogram::of("", "", [], 0)),
                    Block::Pictures(Vec::new()),
                    Block::Table { columns: Vec::new(), rows: Vec::new() },
                ],
            }],
            ..Report::default()
        };
        let page = html(&empty);
        assert!(is_nested(&page) && !page.contains("NaN") && !page.contains("inf"), "{page}");
    }
}
