// SPDX-License-Identifier: Apache-2.0
// Builds the viewer, whose file names have hashes of their contents; with `--mode report` the report,
// one file without references.
import { defineConfig, type Plugin } from 'vite';

/** Inlines script and styles into the page. */
function inline(): Plugin {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_, bundle) {
      let script = '';
      let style = '';
      for (const [name, file] of Object.entries(bundle)) {
        if (name.endsWith('.html')) continue;
        if (file.type === 'chunk') script += file.code;
        else style += String(file.source);
        delete bundle[name];
      }
      const page = bundle['report.html'];
      if (page?.type !== 'asset') throw new Error('report.html is missing');
      page.source = String(page.source)
        .replace(/<script type="module"[^>]*src=[^>]*><\/script>\s*/, '')
        .replace(/<link rel="stylesheet"[^>]*>\s*/, '')
        .replace('</head>', () => `<style>${style}</style>\n  </head>`)
        .replace(
          '</body>',
          () =>
            `<script type="module">${script.replaceAll('</script', '<\\/script')}</script>\n  </body>`,
        );
    },
  };
}

export default defineConfig(({ mode }) => ({
  base: '/',
  plugins: mode === 'report' ? [inline()] : [],
  build: {
    target: 'es2022',
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1000,
    assetsInlineLimit: 0,
    emptyOutDir: mode !== 'report',
    rollupOptions: { input: mode === 'report' ? 'report.html' : 'index.html' },
  },
  server: { proxy: { '/api': { target: 'http://127.0.0.1:8470', changeOrigin: true, ws: true } } },
}));
