// First screen of a study that answers questions: a verdict, and a box for each question.
function showAnswers(study) {
  const verdict = document.getElementById('verdict');
  const answers = document.getElementById('answers');
  verdict.hidden = !study.verdict;
  answers.hidden = !study.answers.length;
  verdict.append(...withMath(study.verdict));
  verdict.className = study.verdict_mark;
  for (const answer of study.answers) {
    const box = element('section', { className: 'answer' }, element('h2', {}, answer.heading));
    box.style.gridColumn = `span ${answer.columns}`;
    for (const [name, key] of [['--label', 'label'], ['--value', 'text']]) {
      box.style.setProperty(name, `${Math.max(0, ...answer.bars.map(bar => bar[key].length)) * 0.6 + 0.8}em`);
    }
    answer.lines.forEach((line, i) => {
      box.append(element('p', { className: line.style }, ...(line.style === 'equation' ? mathOf(line.text) : [setText(line.text)])));
      if (i === 0) box.append(...answer.bars.map(barOf));
    });
    answers.append(box);
  }
}

function barOf(bar) {
  const ink = element('i');
  ink.style.width = `${Math.max(0.6, 100 * Math.min(1, bar.share))}%`;
  ink.style.background = `var(--${bar.color})`;
  return element('div', { className: 'bar' }, element('span', {}, bar.label), element('div', {}, ink), element('b', {}, setText(bar.text)));
}
