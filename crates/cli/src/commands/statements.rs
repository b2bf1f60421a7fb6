// WIP
    /// For a terminal.
    pub fn text(&self) -> String {
        self.statements.iter().map(Statement::text).collect::<Vec<_>>().join("\n")
    }

    /// A table of verdicts, and all statements below it.
    pub fn markdown(&self) -> String {
        let row = |statement: &Statement| {
            let Statement { number, paraphrase, place, .. } = statement;
            format!(
                "| {number} | {} | {place} | {} |\n",
                cell(paraphrase),
                cell(&statement.verdict())
            )
        };
        let rows: String = self.statements.iter().map(row).collect();
        let sections: String = self.statements.iter().map(Statement::markdown).collect();
        format!("| # | statement | in the paper | verdict |\n|---|---|---|---|\n{rows}{sections}")
    }


//----
    fn text(&self) -> String {
        let Self { number, paraphrase, place, finding } = self;
        let width = finding.evidence.iter().map(|(name, _)| name.chars().count()).max();
        let evidence = finding.evidence.iter().map(|(name, value)| {
            format!("  {name:width$}  {}\n", value.text(), width = width.unwrap_or(0))
        });
        format!(
            "Statement {number}, {place}: {paraphrase}\nVerdict: {}\n\n{}{}{}Alone: {}\n",
            self.verdict(),
            evidence.collect::<String>(),
            width.map_or("", |_| "\n"),
            wrapped(&finding.explanation),
            self.command(),
        )
    }

    fn markdown(&self) -> String {
        let Self { number, paraphrase, place, finding } = self;
        let row =
            |(name, value): &(String, Cell)| format!("| {} | {} |\n", cell(name), value.text());
        let rows: String = finding.evidence.iter().map(row).collect();
        let table = if rows.is_empty() {
            String::new()
        } else {
            format!("| evidence | value |\n|---|---|\n{rows}\n")
        };
        format!(
            "\n## {number}. {paraphrase}\n\n{place}. **{}.** {}\n\n{table}`{}`\n",
            self.verdict(),
            finding.explanation,
            self.command(),
        )
    }
}

/// `text` in a cell of a Markdown table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// `text` in lines for a terminal.
fn wrapped(text: &str) -> String {
    const WIDTH: usize = 96;
    let mut out = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > WIDTH {
            out.push('\n');
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out += word;
        column += length;
    }
    out.push('\n');
    out
}
