// Light, dark, or as the system says. The choice is kept where the browser lets a page keep something.
import { button } from './dom';

type Theme = 'system' | 'light' | 'dark';
const NEXT: Record<Theme, Theme> = { system: 'dark', dark: 'light', light: 'system' };
const KEY = 'raygrain-theme';

function kept(): Theme {
  try {
    const theme = localStorage.getItem(KEY);
    return theme === 'light' || theme === 'dark' ? theme : 'system';
  } catch {
    return 'system'; // pages opened from disk may have no storage
  }
}

export function themeButton(): HTMLElement {
  let theme = kept();
  const show = () => {
    document.documentElement.dataset.theme = theme;
    result.textContent = `Colours: ${theme}`;
  };
  const result = button('', 'Light, dark, or as the system says', () => {
    theme = NEXT[theme];
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // it will be asked again
    }
    show();
  });
  result.classList.add('theme');
  show();
  return result;
}
