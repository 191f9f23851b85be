//! A whole report of made-up content, written to the temporary folder to be looked at.
use crate::render::chart::gallery::gallery;
use crate::render::page::html_page::render_html;
use crate::render::page::markdown_page::render_markdown;
use crate::render::page::{Block, Figure, Page, Section, figures};
use crate::render::table::{Cell, Mood, Table, TableColumn};
use oedometer_soil::elementary;

fn orders() -> Table {
    let mut table = Table::of(
        "Relative L_2 error of p at the points, T_v = 0.1",
        vec![
            TableColumn::text("method"),
            TableColumn::number("5 cells"),
            TableColumn::number("10 cells"),
            TableColumn::number("20 cells"),
            TableColumn::number("40 cells"),
            TableColumn::number("order, finest pair"),
            TableColumn::number("order, fit"),
            TableColumn::number("steps"),
            TableColumn::number("time").unit("median of 5"),
            TableColumn::text("verdict"),
        ],
        [],
    );
    for (i, name) in ["MPM", "GIMP", "GIMP-SRI", "GIMP-SRI-patch", "TL-GC-SRI-patch"].into_iter().enumerate()
    {
        let e = elementary::powi(10.0, -1) / (1.0 + f64::from(u8::try_from(i).unwrap_or(0)));
        let missing = || Cell::Missing("left the stable range at step 812 (t = 3.1e-4 s)".into());
        let unstable = i == 0;
        table.rows.push(vec![
            Cell::Code(name.into()),
            Cell::Error(e),
            Cell::Error(e / 2.0),
            Cell::Error(e / 4.1),
            if unstable { missing() } else { Cell::Error(e / 8.3) },
            if unstable { missing() } else { Cell::Order(1.0 + f64::from(u8::from(i > 2))) },
            if unstable { missing() } else { Cell::OrderWithin(1.02, 0.04) },
            Cell::Count(817_500 << i),
            Cell::Seconds(0.012 * elementary::powi(3.0, i32::from(i > 2))),
            match i {
                0 => Cell::Verdict(Mood::Fail, "not-evaluable".into()),
                4 => Cell::Verdict(Mood::Pass, "asymptotic".into()),
                _ => Cell::Verdict(Mood::Note, "floor-limited (reference)".into()),
            },
        ]);
    }
    table.notes.push("Norm: sqrt(Σ V (p − p_exact)² / Σ V p_exact²) over the points, V their volume.".into());
    table
}

fn page() -> Page {
    let mut charts: Vec<Figure> = gallery()
        .into_iter()
        .map(|(name, chart)| Figure::new(name, chart, format!("Made-up data. A caption that says what to see in *{name}*, with `K_w` and T_v spelled as they should be.")))
        .collect();
    let nothing = charts.pop();
    let field = charts.pop();
    let mut twin = field.clone();
    if let Some(twin) = &mut twin {
        twin.name = "pressure-field-exact".into();
    }
    let mut sections = vec![Section {
        heading: "Summary".into(),
        id: "summary".into(),
        mood: None,
        blocks: vec![
            Block::Callout(Mood::Pass, "**41 of 42 expectations met.** `GC-SRI-patch` converges at order 2.00 in p at the points.".into()),
            Block::Callout(Mood::Fail, "`MPM` at 40 cells left the stable range at step 812: time step 3.1e-4 s against a predicted limit of 2.9e-4 s.".into()),
            Block::Callout(Mood::Note, "Timing was taken while other cases ran; it is not comparable between machines.".into()),
            Block::Table(orders()),
            Block::Paragraph("The order of `GIMP-SRI` is **1** at the points and **2** at the cell centres: constant recovery carries the value of the centre to the points, which is wrong by half a cell times the gradient. See [the meshes](#convergence).".into()),
            Block::List(vec!["first, what was done;".into(), "second, what was *not* done, K_w/E_oed being what it is.".into()]),
        ],
    }];
    for figure in charts {
        let (id, heading) = (figure.name.clone(), figure.name.replace('-', " and "));
        sections.push(Section {
            heading,
            id,
            mood: Some(Mood::Pass),
            blocks: vec![
                Block::Paragraph("Column of 1 m, load 1 Pa, two points a cell, held against Terzaghi with compressible water at `T_v` = 0.05, 0.1, 0.2, 0.5.".into()),
                Block::Figure(figure),
                Block::Details { summary: "All numbers".into(), blocks: vec![Block::Table(orders())] },
            ],
        });
    }
    let row: Vec<Figure> = field.into_iter().chain(twin).collect();
    let blocks = [Some(Block::Figures(row)), nothing.map(Block::Figure)];
    sections.push(Section {
        heading: "Fields".into(),
        id: "fields".into(),
        mood: Some(Mood::Fail),
        blocks: blocks.into_iter().flatten().collect(),
    });
    Page {
        title: "Terzaghi's column: convergence of coupled material point methods".into(),
        lead: "How the error of pore pressure, effective stress and settlement falls with cells, points and steps, for five methods, against the exact solution *of the equations that are solved*.".into(),
        sections,
        footer: "Made by `oedometer` 0.1.0 from 120 records; study `terzaghi-mesh`, case hashes 3f2a… to 99c1….".into(),
        ..Page::default()
    }
}

#[test]
fn the_showcase_is_written() {
    let folder = std::env::temp_dir().join("oedometer-gallery/page");
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(&folder)).and_then(|()| std::fs::write(path, text))
    };
    let page = page();
    let html = render_html(&page).unwrap_or_else(|e| panic!("{e}"));
    let markdown = render_markdown(&page).unwrap_or_else(|e| panic!("{e}"));
    let drawn = figures(&page).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(drawn.len(), 9);
    write("index.html", &html).unwrap_or_else(|e| panic!("{e}"));
    write("index.md", &markdown).unwrap_or_else(|e| panic!("{e}"));
    for (name, svg) in drawn {
        write(&format!("figures/{name}"), &svg).unwrap_or_else(|e| panic!("{e}"));
    }
}
